// SPDX-License-Identifier: Apache-2.0
#include "offscreen.h"

#include <epoxy/egl.h>

#include <array>
#include <string>

#include "annotations.h"
#include "frameTarget.h"

namespace osd_shading::viewer {

OffscreenContext::OffscreenContext() : _display(EGL_NO_DISPLAY), _context(EGL_NO_CONTEXT) {
    // Mesa's surfaceless platform needs neither display nor device; other drivers may have a default display.
    EGLDisplay display = EGL_NO_DISPLAY;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    }
    if (display == EGL_NO_DISPLAY) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
        throw GraphicsError("there is no EGL driver to make pictures with (Debian: libgl1-mesa-dri)");
    }
    _display = display;

    std::array<EGLint, 5> const configAttributes = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                                    EGL_OPENGL_BIT, EGL_NONE};
    std::array<EGLint, 7> const contextAttributes = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint numConfigs = 0;
    bool const isReady = eglBindAPI(EGL_OPENGL_API) &&
                         eglChooseConfig(display, configAttributes.data(), &config, 1, &numConfigs) &&
                         numConfigs > 0 &&
                         (_context = eglCreateContext(display, config, EGL_NO_CONTEXT, contextAttributes.data())) &&
                         eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, _context);
    if (!isReady) {
        if (_context != EGL_NO_CONTEXT) eglDestroyContext(display, _context);
        eglTerminate(display);
        throw GraphicsError("the EGL driver has no OpenGL 3.3 without a window");
    }
}

OffscreenContext::~OffscreenContext() {
    eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(_display, _context);
    // The display stays: it is one for the process, and another context may be in use on it.
    eglReleaseThread();
}

Camera CameraFor(CameraChoice const& choice, Scene const& scene, ViewOptions const& view, glm::ivec2 size) {
    return choice.For(scene.bounds, ViewportsOf(view, size)[0].Aspect());
}

Image PictureMaker::Make(std::shared_ptr<Scene const> const& scene, CameraChoice const& camera,
                         ViewOptions const& view, glm::ivec2 size, Selection const& selection,
                         std::vector<std::string> const& lines) {
    ViewFacts const facts = FindViewFacts(*scene, view);
    FrameTarget const target(size);
    target.Bind();
    _renderer.Draw(scene, CameraFor(camera, *scene, view, size), view, facts, selection, size, _text.Scale());
    ImDrawList& list = _text.Begin(size);
    Annotate(list, view, facts, size, _text.Scale(), lines);
    _text.End();
    return target.Read();
}

}  // namespace osd_shading::viewer
