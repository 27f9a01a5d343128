// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace osd_shading::viewer {

/// Something that the graphics driver refuses, in words.
class GraphicsError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Owns one GL object; `Kind` makes and deletes it.
template <typename Kind>
class GlObject {
public:
    GlObject() : _id(Kind::Make()) {}
    ~GlObject() {
        if (_id) Kind::Delete(_id);
    }
    GlObject(GlObject&& other) noexcept : _id(std::exchange(other._id, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(_id, other._id);
        return *this;
    }

    GLuint Id() const { return _id; }

private:
    GLuint _id;
};

#define OSD_SHADING_GL_KIND(Name, plural)                           \
    struct Name##Kind {                                             \
        static GLuint Make() {                                      \
            GLuint id = 0;                                          \
            glGen##plural(1, &id);                                  \
            return id;                                              \
        }                                                           \
        static void Delete(GLuint id) { glDelete##plural(1, &id); } \
    };                                                              \
    using Gl##Name = GlObject<Name##Kind>
OSD_SHADING_GL_KIND(Buffer, Buffers);
OSD_SHADING_GL_KIND(VertexArray, VertexArrays);
OSD_SHADING_GL_KIND(Texture, Textures);
OSD_SHADING_GL_KIND(Framebuffer, Framebuffers);
OSD_SHADING_GL_KIND(Renderbuffer, Renderbuffers);
#undef OSD_SHADING_GL_KIND

struct ProgramKind {
    static GLuint Make() { return glCreateProgram(); }
    static void Delete(GLuint id) { glDeleteProgram(id); }
};
using GlProgram = GlObject<ProgramKind>;

/// Compiles and links; throws GraphicsError with the compiler's words.
GlProgram MakeProgram(std::string const& vertexShader, std::string const& fragmentShader);

/// Replaces what `buffer` holds.
template <typename T>
void Upload(GlBuffer const& buffer, GLenum target, std::vector<T> const& data) {
    glBindBuffer(target, buffer.Id());
    glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_DYNAMIC_DRAW);
}

/// A buffer that shaders read by index.
class TextureBuffer {
public:
    template <typename T>
    void Upload(std::vector<T> const& data, GLenum format) {
        viewer::Upload(_buffer, GL_TEXTURE_BUFFER, data);
        Attach(_buffer, format);
    }
    /// Reads from a buffer that another owner fills.
    void Attach(GlBuffer const& buffer, GLenum format) {
        glBindTexture(GL_TEXTURE_BUFFER, _texture.Id());
        glTexBuffer(GL_TEXTURE_BUFFER, format, buffer.Id());
    }
    void Bind(int unit) const {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_BUFFER, _texture.Id());
    }

private:
    GlBuffer _buffer;
    GlTexture _texture;
};

}  // namespace osd_shading::viewer
