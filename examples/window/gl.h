// The few OpenGL 3.3 functions that the window uses, looked up by GLFW.
#pragma once
#define GLFW_INCLUDE_GLCOREARB
#include <GLFW/glfw3.h>

#include <stdexcept>
#include <string>

#define PLIANT_GL_FUNCTIONS(ROW)                                   \
  ROW(PFNGLATTACHSHADERPROC, AttachShader)                         \
  ROW(PFNGLBINDBUFFERPROC, BindBuffer)                             \
  ROW(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                   \
  ROW(PFNGLBLENDFUNCPROC, BlendFunc)                               \
  ROW(PFNGLBUFFERDATAPROC, BufferData)                             \
  ROW(PFNGLCLEARPROC, Clear)                                       \
  ROW(PFNGLCLEARCOLORPROC, ClearColor)                             \
  ROW(PFNGLCOMPILESHADERPROC, CompileShader)                       \
  ROW(PFNGLCREATEPROGRAMPROC, CreateProgram)                       \
  ROW(PFNGLCREATESHADERPROC, CreateShader)                         \
  ROW(PFNGLDEPTHMASKPROC, DepthMask)                               \
  ROW(PFNGLDISABLEPROC, Disable)                                   \
  ROW(PFNGLDISABLEVERTEXATTRIBARRAYPROC, DisableVertexAttribArray) \
  ROW(PFNGLDRAWARRAYSPROC, DrawArrays)                             \
  ROW(PFNGLDRAWELEMENTSPROC, DrawElements)                         \
  ROW(PFNGLENABLEPROC, Enable)                                     \
  ROW(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray)   \
  ROW(PFNGLGENBUFFERSPROC, GenBuffers)                             \
  ROW(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                   \
  ROW(PFNGLGETPROGRAMIVPROC, GetProgramiv)                         \
  ROW(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)                 \
  ROW(PFNGLGETSHADERIVPROC, GetShaderiv)                           \
  ROW(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)             \
  ROW(PFNGLLINKPROGRAMPROC, LinkProgram)                           \
  ROW(PFNGLPIXELSTOREIPROC, PixelStorei)                           \
  ROW(PFNGLREADPIXELSPROC, ReadPixels)                             \
  ROW(PFNGLSHADERSOURCEPROC, ShaderSource)                         \
  ROW(PFNGLSTENCILFUNCPROC, StencilFunc)                           \
  ROW(PFNGLSTENCILOPPROC, StencilOp)                               \
  ROW(PFNGLUNIFORM1FPROC, Uniform1f)                               \
  ROW(PFNGLUNIFORM3FPROC, Uniform3f)                               \
  ROW(PFNGLUNIFORM1IPROC, Uniform1i)                               \
  ROW(PFNGLUNIFORMMATRIX4FVPROC, UniformMatrix4fv)                 \
  ROW(PFNGLUSEPROGRAMPROC, UseProgram)                             \
  ROW(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer)           \
  ROW(PFNGLVIEWPORTPROC, Viewport)

struct Gl {
#define PLIANT_GL_MEMBER(type, name) type name = nullptr;
  PLIANT_GL_FUNCTIONS(PLIANT_GL_MEMBER)
#undef PLIANT_GL_MEMBER

  /// With a current context. Throws std::runtime_error when a function is missing.
  Gl() {
#define PLIANT_GL_LOAD(type, name) load(name, "gl" #name);
    PLIANT_GL_FUNCTIONS(PLIANT_GL_LOAD)
#undef PLIANT_GL_LOAD
  }

 private:
  template <class Function>
  static void load(Function& function, const char* name) {
    function = reinterpret_cast<Function>(glfwGetProcAddress(name));
    if (function == nullptr) throw std::runtime_error(std::string("OpenGL lacks ") + name);
  }
};
