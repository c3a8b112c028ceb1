// A soft body to play with.
//   window SCENE [--screenshot FILE.png] [--seconds T] [--pull X,Y] [--cut X,Y,X,Y] [--size WxH]
// Left button: grab and pull. With Control: cut along the way of the mouse, as deep as the eye sees. Right button: turn.
// Wheel: nearer and farther. Space: poke what is under the mouse, R: start again.
// --screenshot writes a picture after T seconds of simulation and ends; in its first half --cut sweeps from one place to
// another (parts of the window's height, from its middle), and --pull drags what is in the middle.
#include <pliant/world.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "drawing.h"
#include "io/png.h"

namespace window {
namespace {

struct Options {
  std::string scene, screenshot;
  double seconds = 0.5;
  std::optional<std::array<float, 2>> pull;
  std::optional<std::array<float, 4>> cut;
  int width = 1024, height = 768;
};

Vec3 xyz(const pliant::Vec4f& p) { return {p[0], p[1], p[2]}; }

/// The vertex nearest to the first point where the ray meets the surface; -1: it misses.
std::int32_t vertex_under(const pliant::Frame& frame, const Ray& ray) {
  float nearest = 1e30F;
  std::int32_t found = -1;
  for (const pliant::Triangle& t : frame.triangles) {
    const Vec3 a = xyz(frame.positions[t[0]]), e1 = xyz(frame.positions[t[1]]) - a, e2 = xyz(frame.positions[t[2]]) - a;
    const Vec3 p = cross(ray.along, e2);  // Moeller and Trumbore 1997
    const float det = dot(e1, p);
    if (det == 0) continue;
    const Vec3 s = ray.from - a, q = cross(s, e1);
    const float u = dot(s, p) / det, v = dot(ray.along, q) / det, far = dot(e2, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || far <= 0 || far >= nearest) continue;
    nearest = far;
    found = t[u > v ? (u > 1 - u - v ? 1 : 0) : (v > 1 - u - v ? 2 : 0)];
  }
  return found;
}

class Window {
 public:
  explicit Window(const Options& options)
      : o_(options),
        world_(pliant::World::open(options.scene, {.interactive = true, .cutting = true})),
        frame_(world_.frame()) {
    if (glfwInit() == GLFW_FALSE) throw std::runtime_error("no display: GLFW could not start");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SAMPLES, 4);
    glfwWindowHint(GLFW_STENCIL_BITS, 8);
    window_ = glfwCreateWindow(o_.width, o_.height, "Pliant", nullptr, nullptr);
    if (window_ == nullptr) throw std::runtime_error("no window with OpenGL 3.3 can be opened here");
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double by) {
      auto& camera = static_cast<Window*>(glfwGetWindowUserPointer(w))->camera_;
      camera.distance *= static_cast<float>(std::pow(0.9, by));
    });
    drawing_ = std::make_unique<Drawing>();
    aim();
  }
  ~Window() { glfwTerminate(); }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  int run() {
    while (glfwWindowShouldClose(window_) == GLFW_FALSE) {
      glfwPollEvents();
      simulate();
      drawing_->update(*frame_);
      int width = 0, height = 0;
      glfwGetFramebufferSize(window_, &width, &height);
      drawing_->draw(camera_, std::max(width, 1), std::max(height, 1), ground_);
      if (!o_.screenshot.empty() && frame_->time >= o_.seconds) {
        pliant::write_png(o_.screenshot, {width, height, drawing_->pixels(width, height)});
        std::printf("%s: t = %.3f s, step %lld\n", o_.screenshot.c_str(), frame_->time, static_cast<long long>(frame_->step));
        return 0;
      }
      glfwSwapBuffers(window_);
    }
    return 0;
  }

 private:
  void aim() {
    Vec3 low{1e30F, 1e30F, 1e30F}, high{-1e30F, -1e30F, -1e30F};
    for (const pliant::Vec4f& p : frame_->positions) {
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], p[c]);
        high[c] = std::max(high[c], p[c]);
      }
    }
    const Vec3 size = high - low;
    camera_.target = (low + high) * 0.5F;
    camera_.distance = start_distance_ = 2.1F * std::sqrt(dot(size, size));
    ground_ = low[1];
  }

  [[nodiscard]] Ray ray_at(float x, float y) const {
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    const float w = static_cast<float>(std::max(width, 1)), h = static_cast<float>(std::max(height, 1));
    return camera_.ray(2 * x / w - 1, 1 - 2 * y / h, w / h);
  }

  void grab(const Ray& ray) {
    const std::int32_t vertex = vertex_under(*frame_, ray);
    if (vertex < 0) return;
    held_from_ = xyz(frame_->positions[static_cast<std::size_t>(vertex)]);
    held_ = world_.grab(vertex, {.radius = 0.03 * static_cast<double>(start_distance_)});
  }

  /// The hand stays in the plane through where it began that faces the viewer.
  void drag(const Ray& ray) {
    const Vec3 back = camera_.back();
    const float facing = dot(ray.along, back);
    if (held_ == 0 || facing >= 0) return;
    const Vec3 to = ray.from + ray.along * (dot(held_from_ - ray.from, back) / facing);
    world_.move_grab(held_, {to[0], to[1], to[2]});
  }

  void poke(const Ray& ray, bool wanted) {
    if (poked_ >= 0 && !wanted) {
      world_.push(poked_, {});
      poked_ = -1;
    }
    if (!wanted || poked_ >= 0) return;
    poked_ = vertex_under(*frame_, ray);
    if (poked_ < 0) return;
    double mass = 0;
    for (const pliant::BodyInfo& body : world_.info().bodies) mass += body.mass;
    const double force = 2 * 9.81 * mass;  // twice the weight
    world_.push(poked_, {force * static_cast<double>(ray.along[0]), force * static_cast<double>(ray.along[1]),
                         force * static_cast<double>(ray.along[2])});
  }

  /// A blade along the line of sight, through everything that is there.
  void cut(const Ray& ray) {
    const float reach = camera_.distance + 2 * start_distance_;
    const Vec3 near = ray.from + ray.along * (0.01F * reach), far = ray.from + ray.along * reach;
    world_.move_blade("mouse", {near[0], near[1], near[2]}, {far[0], far[1], far[2]});
    cutting_ = true;
  }

  void lift() {
    if (cutting_) world_.lift_blade("mouse");
    cutting_ = false;
  }

  void use_mouse() {
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    const Ray ray = ray_at(static_cast<float>(x), static_cast<float>(y));
    const bool pressed = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    const bool blade = pressed && held_ == 0 &&
                       (cutting_ || glfwGetKey(window_, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS ||
                        glfwGetKey(window_, GLFW_KEY_RIGHT_CONTROL) == GLFW_PRESS);
    blade ? cut(ray) : lift();
    const bool left = pressed && !blade;
    if (left && held_ == 0) grab(ray);
    if (left) drag(ray);
    if (!left && held_ != 0) {
      world_.release(held_);
      held_ = 0;
    }
    if (glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS) {
      camera_.turn -= 0.008F * static_cast<float>(x - last_x_);
      camera_.lift = std::clamp(camera_.lift + 0.008F * static_cast<float>(y - last_y_), -1.5F, 1.5F);
    }
    last_x_ = x;
    last_y_ = y;
    poke(ray, glfwGetKey(window_, GLFW_KEY_SPACE) == GLFW_PRESS);
  }

  /// What --cut and --pull do: blade and hand reach their goal within the first half of the time.
  void use_script() {
    const float w = static_cast<float>(o_.width), h = static_cast<float>(o_.height);
    const float share = static_cast<float>(std::min(1.0, 2 * frame_->time / o_.seconds));
    if (o_.pull) {
      if (held_ == 0) grab(ray_at(w / 2, h / 2));
      drag(ray_at(w / 2 + share * (*o_.pull)[0] * h, h / 2 - share * (*o_.pull)[1] * h));
    }
    if (!o_.cut) return;
    const auto& [x0, y0, x1, y1] = *o_.cut;
    cut(ray_at(w / 2 + (x0 + share * (x1 - x0)) * h, h / 2 - (y0 + share * (y1 - y0)) * h));
  }

  void simulate() {
    if (o_.pull || o_.cut) {
      use_script();
    } else {
      use_mouse();
    }
    if (glfwGetKey(window_, GLFW_KEY_R) == GLFW_PRESS) {
      world_.reset();
      held_ = 0;
      poked_ = -1;
      cutting_ = false;
    }
    // The worker computes the next sixtieth of a second while this frame is drawn; the window never waits for it.
    if (!o_.screenshot.empty()) {
      world_.advance(1.0 / 60);
    } else if (!world_.busy()) {
      world_.advance_async(1.0 / 60);
    }
    frame_ = world_.frame();
  }

  Options o_;
  pliant::World world_;
  pliant::FramePtr frame_;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<Drawing> drawing_;
  Orbit camera_;
  float ground_ = 0, start_distance_ = 1;
  pliant::GrabId held_ = 0;
  Vec3 held_from_{};
  std::int32_t poked_ = -1;
  bool cutting_ = false;
  double last_x_ = 0, last_y_ = 0;
};

Options read(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const char* const value = i + 1 < argc ? argv[i + 1] : "";
    float x = 0, y = 0, to_x = 0, to_y = 0;
    if (word == "--screenshot") {
      o.screenshot = value;
    } else if (word == "--seconds") {
      o.seconds = std::atof(value);
    } else if (word == "--pull" && std::sscanf(value, "%f,%f", &x, &y) == 2) {
      o.pull = {x, y};
    } else if (word == "--cut" && std::sscanf(value, "%f,%f,%f,%f", &x, &y, &to_x, &to_y) == 4) {
      o.cut = {x, y, to_x, to_y};
    } else if (word == "--size" && std::sscanf(value, "%dx%d", &o.width, &o.height) == 2) {
    } else if (word[0] != '-' && o.scene.empty()) {
      o.scene = word;
      continue;
    } else {
      throw std::runtime_error("not understood: " + word);
    }
    ++i;
  }
  if (o.scene.empty())
    throw std::runtime_error("usage: window SCENE [--screenshot FILE] [--seconds T] [--pull X,Y] [--cut X,Y,X,Y] [--size WxH]");
  return o;
}

}  // namespace
}  // namespace window

int main(int argc, char** argv) try {
  return window::Window(window::read(argc, argv)).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "window: %s\n", error.what());
  return 2;
}
