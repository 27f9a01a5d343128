// SPDX-License-Identifier: Apache-2.0
#include "glObjects.h"

namespace osd_shading::viewer {

namespace {

class Shader {
public:
    Shader(GLenum stage, std::string const& source) : _id(glCreateShader(stage)) {
        char const* const text = source.c_str();
        glShaderSource(_id, 1, &text, nullptr);
        glCompileShader(_id);
        GLint isCompiled = 0, length = 0;
        glGetShaderiv(_id, GL_COMPILE_STATUS, &isCompiled);
        if (isCompiled) return;
        glGetShaderiv(_id, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), ' ');
        glGetShaderInfoLog(_id, length, nullptr, log.data());
        glDeleteShader(_id);
        throw GraphicsError("a shader does not compile: " + log);
    }
    ~Shader() { glDeleteShader(_id); }
    Shader(Shader const&) = delete;
    Shader& operator=(Shader const&) = delete;

    GLuint Id() const { return _id; }

private:
    GLuint _id;
};

}  // namespace

GlProgram MakeProgram(std::string const& vertexShader, std::string const& fragmentShader) {
    Shader const vertex(GL_VERTEX_SHADER, vertexShader), fragment(GL_FRAGMENT_SHADER, fragmentShader);
    GlProgram program;
    glAttachShader(program.Id(), vertex.Id());
    glAttachShader(program.Id(), fragment.Id());
    glLinkProgram(program.Id());
    glDetachShader(program.Id(), vertex.Id());
    glDetachShader(program.Id(), fragment.Id());
    GLint isLinked = 0, length = 0;
    glGetProgramiv(program.Id(), GL_LINK_STATUS, &isLinked);
    if (!isLinked) {
        glGetProgramiv(program.Id(), GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), ' ');
        glGetProgramInfoLog(program.Id(), length, nullptr, log.data());
        throw GraphicsError("a shader program does not link: " + log);
    }
    return program;
}

}  // namespace osd_shading::viewer
