#include "drawing.h"

#include <algorithm>
#include <cmath>

namespace window {
namespace {

const char* const kBodyVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float value;
uniform mat4 matrix;
uniform mat4 pose;
out vec3 place;
out vec3 direction;
out float share;
void main() {
  share = value;
  place = (pose * vec4(position, 1)).xyz;
  direction = mat3(pose) * normal;
  gl_Position = matrix * vec4(place, 1);
})";

// A key light, a sky, the ground's light from below, and a highlight.
const char* const kBodyFragment = R"(#version 330 core
in vec3 place;
in vec3 direction;
in float share;
uniform vec3 eye;
uniform vec3 color;
uniform vec3 key;
uniform vec3 ramp[5];
uniform int inside;
uniform int colored;
out vec4 result;
void main() {
  float at = 4.0 * clamp(share, 0.0, 1.0);
  int k = min(int(at), 3);
  vec3 own = colored == 1 ? mix(ramp[k], ramp[k + 1], at - float(k)) : color;
  vec3 v = normalize(eye - place);
  // Normals along the rim of a cut are the skin's: faces of a cut have their own.
  vec3 n = normalize(inside == 1 ? cross(dFdx(place), dFdy(place)) : direction);
  if (inside == 0 && !gl_FrontFacing) n = -n;
  vec3 sky = mix(vec3(0.22, 0.19, 0.18), vec3(0.52, 0.55, 0.60), 0.5 + 0.5 * n.y);
  float facing = max(dot(n, key), 0.0);
  vec3 light = own * (sky + vec3(0.95, 0.91, 0.86) * facing);
  float shine = pow(max(dot(n, normalize(key + v)), 0.0), 60.0) * 0.35;
  float rim = pow(1.0 - max(dot(n, v), 0.0), 4.0) * 0.18;
  result = vec4(pow(light + shine + rim, vec3(1 / 2.2)), 1);
})";

// The ground, and shadows: the body projected along the light.
const char* const kFlatVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 matrix;
uniform mat4 pose;
uniform vec3 key;
uniform float ground;
uniform int shadow;
out vec3 place;
void main() {
  place = (pose * vec4(position, 1)).xyz;
  if (shadow == 1) place -= key * ((place.y - ground) / key.y);
  gl_Position = matrix * vec4(place, 1);
})";
const char* const kFlatFragment = R"(#version 330 core
in vec3 place;
uniform vec3 eye;
uniform vec3 target;
uniform float size;
uniform int shadow;
out vec4 result;
void main() {
  float far = length(place - target) / size;
  if (shadow == 1) {
    result = vec4(0.10, 0.10, 0.13, 0.30);
  } else {
    vec2 line = abs(fract(place.xz / (0.1 * size) + 0.5) - 0.5) / fwidth(place.xz / (0.1 * size));
    float grid = 1.0 - min(min(line.x, line.y), 1.0);
    result = vec4(mix(vec3(0.86, 0.87, 0.88), vec3(0.78, 0.79, 0.81), grid * 0.7), 1.0 - smoothstep(0.8, 3.0, far));
  }
})";

GLuint shader(const Gl& gl, GLenum kind, const char* text) {
  const GLuint id = gl.CreateShader(kind);
  gl.ShaderSource(id, 1, &text, nullptr);
  gl.CompileShader(id);
  GLint good = 0;
  gl.GetShaderiv(id, GL_COMPILE_STATUS, &good);
  if (good == 0) {
    char log[1024] = "";
    gl.GetShaderInfoLog(id, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("shader: ") + log);
  }
  return id;
}

GLuint program(const Gl& gl, const char* vertex, const char* fragment) {
  const GLuint id = gl.CreateProgram();
  gl.AttachShader(id, shader(gl, GL_VERTEX_SHADER, vertex));
  gl.AttachShader(id, shader(gl, GL_FRAGMENT_SHADER, fragment));
  gl.LinkProgram(id);
  GLint good = 0;
  gl.GetProgramiv(id, GL_LINK_STATUS, &good);
  if (good == 0) throw std::runtime_error("shaders do not link");
  return id;
}

void set(const Gl& gl, GLuint program, const char* name, Vec3 v) {
  gl.Uniform3f(gl.GetUniformLocation(program, name), v[0], v[1], v[2]);
}
void set(const Gl& gl, GLuint program, const char* name, float v) { gl.Uniform1f(gl.GetUniformLocation(program, name), v); }
void set(const Gl& gl, GLuint program, const char* name, int v) { gl.Uniform1i(gl.GetUniformLocation(program, name), v); }
void set(const Gl& gl, GLuint program, const char* name, const Mat4& m) {
  gl.UniformMatrix4fv(gl.GetUniformLocation(program, name), 1, GL_FALSE, m.data());
}

const Mat4 kStill{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// Three corners per triangle with position and normal: the mean of the faces at the vertex that meet at less than 40 degrees.
std::vector<float> shaded(const pliant::SurfaceSpec& surface) {
  const auto point = [&](std::int32_t v) {
    const pliant::Vec3d& x = surface.vertices[static_cast<std::size_t>(v)];
    return Vec3{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
  };
  std::vector<Vec3> normal;
  std::vector<std::vector<std::size_t>> around(surface.vertices.size());
  for (const pliant::Triangle& t : surface.triangles) {
    const Vec3 n = cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0]));
    for (const std::int32_t v : t) around[static_cast<std::size_t>(v)].push_back(normal.size());
    normal.push_back(n * (1 / std::max(std::sqrt(dot(n, n)), 1e-30F)));
  }
  std::vector<float> corners;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const std::int32_t v : surface.triangles[t]) {
      Vec3 sum{};
      for (const std::size_t other : around[static_cast<std::size_t>(v)]) {
        if (dot(normal[other], normal[t]) > 0.766F) sum = sum + normal[other];
      }
      for (const Vec3& x : {point(v), sum}) corners.insert(corners.end(), x.begin(), x.end());
    }
  }
  return corners;
}

}  // namespace

Mat4 pose_matrix(const pliant::Vec3d& at, const std::array<double, 4>& turn) {
  const auto [x, y, z, w] = turn;
  const std::array<double, 16> m{1 - 2 * (y * y + z * z),
                                 2 * (x * y + z * w),
                                 2 * (x * z - y * w),
                                 0,
                                 2 * (x * y - z * w),
                                 1 - 2 * (x * x + z * z),
                                 2 * (y * z + x * w),
                                 0,
                                 2 * (x * z + y * w),
                                 2 * (y * z - x * w),
                                 1 - 2 * (x * x + y * y),
                                 0,
                                 at[0],
                                 at[1],
                                 at[2],
                                 1};
  Mat4 out;
  std::transform(m.begin(), m.end(), out.begin(), [](double value) { return static_cast<float>(value); });
  return out;
}

Drawing::Drawing() {
  body_program_ = program(gl_, kBodyVertex, kBodyFragment);
  flat_program_ = program(gl_, kFlatVertex, kFlatFragment);
  gl_.GenVertexArrays(1, &body_);
  gl_.GenVertexArrays(1, &ground_);
  for (GLuint* buffer : {&positions_, &normals_, &values_, &indices_, &ground_corners_}) gl_.GenBuffers(1, buffer);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.Enable(GL_MULTISAMPLE);
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

void Drawing::set_topology(const pliant::Frame& frame) {
  std::vector<pliant::Triangle> order, cut;
  for (std::size_t t = 0; t < frame.triangles.size(); ++t) {
    (!frame.cut_faces.empty() && frame.cut_faces[t] != 0 ? cut : order).push_back(frame.triangles[t]);
  }
  outside_ = static_cast<GLsizei>(3 * order.size());
  cut_ = static_cast<GLsizei>(3 * cut.size());
  order.insert(order.end(), cut.begin(), cut.end());
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(order.size() * sizeof order[0]), order.data(),
                 GL_STATIC_DRAW);
  topology_ = frame.topology_version;
  empty_ = false;
}

void Drawing::update(const pliant::Frame& frame) {
  gl_.BindVertexArray(body_);
  const auto upload = [&](GLuint buffer, GLuint place, const pliant::View<pliant::Vec4f>& data) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(pliant::Vec4f)), data.data(), GL_STREAM_DRAW);
    gl_.VertexAttribPointer(place, 3, GL_FLOAT, GL_FALSE, sizeof(pliant::Vec4f), nullptr);
    gl_.EnableVertexAttribArray(place);
  };
  upload(positions_, 0, frame.positions);
  upload(normals_, 1, frame.normals);
  if (empty_ || topology_ != frame.topology_version) set_topology(frame);
  vertices_ = frame.positions.size();
}

void Drawing::set_values(const std::vector<float>& values, float most) {
  colored_ = !values.empty() && values.size() == vertices_;
  gl_.BindVertexArray(body_);
  if (!colored_) return gl_.DisableVertexAttribArray(2);
  std::vector<float> shares;
  for (const float value : values) shares.push_back(most > 0 ? value / most : 0);
  gl_.BindBuffer(GL_ARRAY_BUFFER, values_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(shares.size() * sizeof(float)), shares.data(), GL_STREAM_DRAW);
  gl_.VertexAttribPointer(2, 1, GL_FLOAT, GL_FALSE, sizeof(float), nullptr);
  gl_.EnableVertexAttribArray(2);
}

void Drawing::set_tool(const std::string& name, const pliant::SurfaceSpec& surface) {
  Solid& tool = tools_[name];
  if (tool.array == 0) {
    gl_.GenVertexArrays(1, &tool.array);
    gl_.GenBuffers(1, &tool.corners);
  }
  const std::vector<float> corners = shaded(surface);
  tool.count = static_cast<GLsizei>(corners.size() / 6);
  gl_.BindVertexArray(tool.array);
  gl_.BindBuffer(GL_ARRAY_BUFFER, tool.corners);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(float)), corners.data(), GL_STATIC_DRAW);
  for (GLuint i = 0; i < 2; ++i) {
    gl_.VertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 6 * sizeof(float), reinterpret_cast<const void*>(3 * i * sizeof(float)));
    gl_.EnableVertexAttribArray(i);
  }
}

void Drawing::hide_tools() {
  for (auto& [name, tool] : tools_) tool.look = ToolLook::hidden;
}

void Drawing::place_tool(const std::string& name, const Mat4& pose, ToolLook look) {
  tools_.at(name).pose = pose;
  tools_.at(name).look = look;
}

void Drawing::draw_tools(GLuint program) {
  for (const auto& [name, tool] : tools_) {
    if (tool.look == ToolLook::hidden || tool.count == 0) continue;
    set(gl_, program, "pose", tool.pose);
    if (program == body_program_) {
      set(gl_, program, "color", tool.look == ToolLook::active ? Vec3{0.75F, 0.55F, 0.20F} : Vec3{0.42F, 0.45F, 0.50F});
    }
    gl_.BindVertexArray(tool.array);
    gl_.DrawArrays(GL_TRIANGLES, 0, tool.count);
  }
  set(gl_, program, "pose", kStill);
}

void Drawing::draw_body() {
  gl_.BindVertexArray(body_);
  set(gl_, body_program_, "inside", 0);
  set(gl_, body_program_, "colored", colored_ ? 1 : 0);
  gl_.DrawElements(GL_TRIANGLES, outside_, GL_UNSIGNED_INT, nullptr);
  if (cut_ == 0) return;
  set(gl_, body_program_, "inside", 1);
  set(gl_, body_program_, "color", Vec3{0.72F, 0.34F, 0.30F});
  gl_.DrawElements(GL_TRIANGLES, cut_, GL_UNSIGNED_INT, reinterpret_cast<const void*>(sizeof(GLuint) * outside_));
}

void Drawing::draw_ground(const Mat4& matrix, const Orbit& camera, float ground) {
  const float r = 4 * camera.distance;
  const Vec3 c = camera.target;
  const std::array<Vec3, 4> corners{Vec3{c[0] - r, ground, c[2] - r}, Vec3{c[0] + r, ground, c[2] - r},
                                    Vec3{c[0] - r, ground, c[2] + r}, Vec3{c[0] + r, ground, c[2] + r}};
  gl_.BindVertexArray(ground_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, ground_corners_);
  gl_.BufferData(GL_ARRAY_BUFFER, sizeof corners, corners.data(), GL_STREAM_DRAW);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3), nullptr);
  gl_.EnableVertexAttribArray(0);
  set(gl_, flat_program_, "matrix", matrix);
  set(gl_, flat_program_, "target", Vec3{c[0], ground, c[2]});
  set(gl_, flat_program_, "size", 0.5F * camera.distance);
  set(gl_, flat_program_, "ground", ground);
  set(gl_, flat_program_, "shadow", 0);
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  // Each pixel of the shadow once, however many triangles fall on it.
  gl_.Enable(GL_STENCIL_TEST);
  gl_.StencilFunc(GL_EQUAL, 0, 0xff);
  gl_.StencilOp(GL_KEEP, GL_INCR, GL_INCR);
  set(gl_, flat_program_, "shadow", 1);
  gl_.BindVertexArray(body_);
  gl_.DrawElements(GL_TRIANGLES, outside_ + cut_, GL_UNSIGNED_INT, nullptr);
  draw_tools(flat_program_);
  gl_.Disable(GL_STENCIL_TEST);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

void Drawing::draw(const Orbit& camera, int width, int height, float ground) {
  gl_.Viewport(0, 0, width, height);
  gl_.ClearColor(0.90F, 0.91F, 0.93F, 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  const Mat4 matrix = camera.matrix(static_cast<float>(width) / static_cast<float>(height));
  const Vec3 key = unit(camera.right() * -0.8F + Vec3{0, 1.2F, 0} + camera.back() * 0.5F);
  gl_.UseProgram(flat_program_);
  set(gl_, flat_program_, "key", key);
  set(gl_, flat_program_, "pose", kStill);
  draw_ground(matrix, camera, ground);
  gl_.UseProgram(body_program_);
  set(gl_, body_program_, "matrix", matrix);
  set(gl_, body_program_, "pose", kStill);
  set(gl_, body_program_, "eye", camera.eye());
  set(gl_, body_program_, "key", key);
  set(gl_, body_program_, "color", Vec3{0.42F, 0.075F, 0.055F});
  for (std::size_t i = 0; i < kRamp.size(); ++i) {  // the shader works with linear light
    Vec3 linear = kRamp[i];
    for (float& c : linear) c = std::pow(c, 2.2F);
    set(gl_, body_program_, ("ramp[" + std::to_string(i) + "]").c_str(), linear);
  }
  draw_body();
  set(gl_, body_program_, "inside", 0);
  set(gl_, body_program_, "colored", 0);
  draw_tools(body_program_);
}

std::vector<std::uint8_t> Drawing::pixels(int width, int height) const {
  const auto row = 3 * static_cast<std::size_t>(width);
  std::vector<std::uint8_t> up(row * static_cast<std::size_t>(height)), down;
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, up.data());
  for (std::size_t y = static_cast<std::size_t>(height); y-- > 0;) {
    down.insert(down.end(), up.begin() + static_cast<std::ptrdiff_t>(y * row),
                up.begin() + static_cast<std::ptrdiff_t>((y + 1) * row));
  }
  return down;
}

}  // namespace window
