// A soft body to play with, and instruments.
//   window SCENE [--screenshot FILE.png] [--seconds T] [--pull X,Y] [--cut X,Y,X,Y] [--depth D] [--probe D] [--grasp D]
//          [--set LABEL=VALUE] [--live DEVICE [--tool NAME]] [--size WxH]
// Left button: grab and pull. With Control: cut along the way of the mouse, as deep as the panel says. Right button: turn.
// Space: poke what is under the mouse. R: start again. P: a probe, G: a grasper, 1 to 9: the scene's tools, 0: the hand.
// --live: a haptic device drives a tool or a blade by force (docs/haptic_devices.md), and the panel shows what the hand feels.
// With an instrument the mouse moves it, the wheel pushes it deeper, Shift turns it; arrows, PageUp and PageDown likewise.
// --screenshot writes a picture after T seconds of simulation and ends; in its first half --cut sweeps from one place to
// another (parts of the window's height, from its middle) with a blade of --depth D (sizes of the body), --pull drags what is
// in the middle, --probe and --grasp push an instrument D sizes deep there, --set moves a slider at the start.
#include <pliant/world.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "coloring.h"
#include "drawing.h"
#include "hands.h"
#include "instruments.h"
#include "io/png.h"
#include "options.h"
#include "panel.h"

namespace window {
namespace {

Vec3 xyz(const pliant::Vec4f& p) { return {p[0], p[1], p[2]}; }

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
      static_cast<Window*>(glfwGetWindowUserPointer(w))->scrolled_ += static_cast<float>(by);
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
      if (action == GLFW_PRESS) static_cast<Window*>(glfwGetWindowUserPointer(w))->pressed_.push_back(key);
    });
    drawing_ = std::make_unique<Drawing>();
    panel_ = std::make_unique<Panel>(window_, sliders_of(o_.scene));  // after the callbacks, which it calls
    panel_->depth = o_.depth;
    panel_->choose_color(o_.color);
    aim();
    hands_ = std::make_unique<Hands>(world_, o_.live, o_.tool);
    instruments_ = std::make_unique<Instruments>(world_, *drawing_, size_, hands_->tools());
    instruments_->follow_scene();
  }
  ~Window() {
    panel_.reset();
    glfwTerminate();
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  int run() {
    while (glfwWindowShouldClose(window_) == GLFW_FALSE) {
      glfwPollEvents();
      follow(panel_->show({instruments_->labels(), hands_->lines(), instruments_->active(), instruments_->force(), frame_->time,
                           speed(), coloring_.most(), message_}));
      simulate();
      drawing_->update(*frame_);
      coloring_.apply(*drawing_);
      instruments_->draw();
      int width = 0, height = 0;
      glfwGetFramebufferSize(window_, &width, &height);
      drawing_->draw(camera_, std::max(width, 1), std::max(height, 1), ground_);
      panel_->draw();
      if (!o_.screenshot.empty() && frame_->time >= o_.seconds) {
        pliant::write_png(o_.screenshot, {width, height, drawing_->pixels(width, height)});
        std::printf("%s: t = %.3f s, step %lld\n", o_.screenshot.c_str(), frame_->time, static_cast<long long>(frame_->step));
        for (const std::string& line : hands_->lines()) std::printf("%s\n", line.c_str());
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
    size_ = std::sqrt(dot(size, size));
    camera_.distance = start_distance_ = 2.1F * size_;
    ground_ = low[1];
  }

  [[nodiscard]] Ray ray_at(float x, float y) const {
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    const float w = static_cast<float>(std::max(width, 1)), h = static_cast<float>(std::max(height, 1));
    return camera_.ray(2 * x / w - 1, 1 - 2 * y / h, w / h);
  }

  [[nodiscard]] std::optional<pliant::PickedPoint> pick(const Ray& ray) const {
    return world_.pick(wide(ray.from), wide(ray.along));
  }

  void grab(const Ray& ray) {
    const auto picked = pick(ray);
    if (!picked) return;
    held_from_ = xyz(frame_->positions[picked->vertex]);
    held_ = world_.grab(picked->vertex, {.radius = 0.03 * static_cast<double>(start_distance_)});
  }

  /// The hand stays in the plane through where it began that faces the viewer.
  void drag(const Ray& ray) {
    const Vec3 back = camera_.back();
    const float facing = dot(ray.along, back);
    if (held_ == 0 || facing >= 0) return;
    const Vec3 to = ray.from + ray.along * (dot(held_from_ - ray.from, back) / facing);
    world_.move_grab(held_, wide(to));
  }

  void poke(const Ray& ray, bool wanted) {
    if (poked_ >= 0 && !wanted) {
      world_.push(poked_, {});
      poked_ = -1;
    }
    if (!wanted || poked_ >= 0) return;
    const auto picked = pick(ray);
    if (!picked) return;
    poked_ = picked->vertex;
    double mass = 0;
    for (const pliant::BodyInfo& body : world_.info().bodies) mass += body.mass;
    const double force = 2 * 9.81 * mass;  // twice the weight
    world_.push(poked_, {force * static_cast<double>(ray.along[0]), force * static_cast<double>(ray.along[1]),
                         force * static_cast<double>(ray.along[2])});
  }

  /// A blade along the line of sight: from a little before the surface to `depth` behind it, or through everything.
  void cut(const Ray& ray) {
    const float reach = camera_.distance + 2 * start_distance_;
    float from = 0.01F * reach, to = reach;
    if (panel_->depth < 1) {
      if (const auto picked = pick(ray)) surface_ = static_cast<float>(picked->distance);
      from = surface_ - 0.02F * size_;
      to = surface_ + panel_->depth * size_;
    }
    const Vec3 near = ray.from + ray.along * from, far = ray.from + ray.along * to;
    world_.move_blade("mouse", wide(near), wide(far));
    cutting_ = true;
  }

  void lift() {
    if (cutting_) world_.lift_blade("mouse");
    cutting_ = false;
  }

  [[nodiscard]] bool key(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }
  [[nodiscard]] bool shift() const { return key(GLFW_KEY_LEFT_SHIFT) || key(GLFW_KEY_RIGHT_SHIFT); }
  [[nodiscard]] bool control() const { return key(GLFW_KEY_LEFT_CONTROL) || key(GLFW_KEY_RIGHT_CONTROL); }

  /// Grabs, cuts and pokes.
  void use_hand(const Ray& ray, bool pressed) {
    const bool blade = pressed && held_ == 0 && (cutting_ || control());
    blade ? cut(ray) : lift();
    const bool left = pressed && !blade;
    if (left && held_ == 0) grab(ray);
    if (left) drag(ray);
    if (!left) let_go();
    poke(ray, key(GLFW_KEY_SPACE));
  }

  void let_go() {
    if (held_ != 0) world_.release(held_);
    held_ = 0;
  }

  /// Six degrees of freedom: `across` and `up` move in the plane of the window, or turn about its axes, `deeper` along the
  /// view, or turns about it.
  void move_instrument(float across, float up, float deeper) {
    if (across == 0 && up == 0 && deeper == 0) return;
    if (shift()) {
      instruments_->turn(camera_.up(), 4 * across);
      instruments_->turn(camera_.right(), -4 * up);
      instruments_->turn(camera_.back(), 4 * deeper);
    } else {
      const float scale = 2 * camera_.half_height * camera_.distance;
      instruments_->move(camera_.right() * (scale * across) + camera_.up() * (scale * up) - camera_.back() * (scale * deeper));
    }
  }

  void use_instrument(float across, float up, float wheel) {
    constexpr float kStep = 0.008F;
    const auto held = [&](int more, int less) { return kStep * static_cast<float>((key(more) ? 1 : 0) - (key(less) ? 1 : 0)); };
    move_instrument(across + held(GLFW_KEY_RIGHT, GLFW_KEY_LEFT), up + held(GLFW_KEY_UP, GLFW_KEY_DOWN),
                    0.02F * wheel + held(GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN));
    instruments_->close(glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS && !panel_->takes_mouse());
  }

  void use_mouse() {
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    const auto high = static_cast<float>(std::max(height, 1));
    const float across = static_cast<float>(x - last_x_) / high, up = static_cast<float>(last_y_ - y) / high;
    last_x_ = x;
    last_y_ = y;
    const float wheel = std::exchange(scrolled_, 0.0F);
    const bool free = !panel_->takes_mouse();
    const bool turning = free && glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    if (turning) {
      camera_.turn -= 6 * across;
      camera_.lift = std::clamp(camera_.lift - 6 * up, -1.5F, 1.5F);
    }
    const bool nearer = !instruments_->held() || control();
    if (free && nearer) camera_.distance *= std::pow(0.9F, wheel);
    if (instruments_->held()) {
      let_go();
      lift();
      use_instrument(free && !turning ? across : 0, free && !turning ? up : 0, free && !nearer ? wheel : 0);
    } else {
      use_hand(ray_at(static_cast<float>(x), static_cast<float>(y)),
               free && glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS);
    }
  }

  /// Before the middle of what the window shows, a little off the surface.
  [[nodiscard]] Vec3 before_the_body() const {
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    const Ray ray = ray_at(0.5F * static_cast<float>(width), 0.5F * static_cast<float>(height));
    const auto picked = pick(ray);
    return ray.from + ray.along * ((picked ? static_cast<float>(picked->distance) : camera_.distance) - 0.05F * size_);
  }

  /// Direction of the handle of a new instrument: towards the viewer, and up so that it does not hide its tip.
  [[nodiscard]] Vec3 handle() const { return unit(camera_.back() + camera_.up() * 0.8F); }

  void start_again() {
    world_.reset();
    held_ = 0;
    poked_ = -1;
    cutting_ = false;
    message_.clear();
    panel_->reset();
    instruments_->follow_scene();
  }

  void follow(const PanelChoice& choice) {
    std::vector<int> keys = std::exchange(pressed_, {});
    if (panel_->takes_keys()) keys.clear();
    const auto chosen = [&](int key) { return std::count(keys.begin(), keys.end(), key) > 0; };
    try {
      if (choice.probe || chosen(GLFW_KEY_P)) instruments_->take_probe(before_the_body(), handle());
      if (choice.grasper || chosen(GLFW_KEY_G)) instruments_->take_grasper(before_the_body(), handle());
      if (choice.instrument >= 0) instruments_->take(static_cast<std::size_t>(choice.instrument));
      for (int n = 0; n < 9; ++n) {
        if (chosen(GLFW_KEY_1 + n)) instruments_->take(static_cast<std::size_t>(n));
      }
      if (choice.hand || chosen(GLFW_KEY_0) || chosen(GLFW_KEY_ESCAPE)) instruments_->put_down();
      if (choice.reset || chosen(GLFW_KEY_R)) start_again();
      for (const std::string& change : choice.changes) world_.parse_change(change);
      if (!choice.changes.empty()) message_.clear();
    } catch (const pliant::Error& error) {
      message_ = error.what();
    }
  }

  /// What the options for pictures do: blade, hand and instruments reach their goal within the first half of the time.
  void use_script() {
    const float w = static_cast<float>(o_.width), h = static_cast<float>(o_.height);
    const float share = static_cast<float>(std::min(1.0, 2 * frame_->time / o_.seconds));
    if (!o_.set.empty()) {
      const std::size_t at = o_.set.find('=');
      const std::string change = panel_->set(o_.set.substr(0, at), std::stof(o_.set.substr(at + 1)));
      if (change.empty()) throw std::runtime_error("--set: no slider '" + o_.set.substr(0, at) + "'");
      world_.parse_change(change);
      o_.set.clear();
    }
    if (o_.pull) {
      if (held_ == 0) grab(ray_at(w / 2, h / 2));
      drag(ray_at(w / 2 + share * (*o_.pull)[0] * h, h / 2 - share * (*o_.pull)[1] * h));
    }
    const float deep = std::max(o_.probe, o_.grasp);
    if (deep > 0) {
      if (!instruments_->held()) {
        o_.probe > 0 ? instruments_->take_probe(before_the_body(), handle())
                     : instruments_->take_grasper(before_the_body(), handle());
      }
      instruments_->move(camera_.back() * ((sent_ - share) * (deep + 0.05F) * size_));
      sent_ = share;
      instruments_->close(share >= 1);
    }
    if (!o_.cut) return;
    const auto& [x0, y0, x1, y1] = *o_.cut;
    cut(ray_at(w / 2 + (x0 + share * (x1 - x0)) * h, h / 2 - (y0 + share * (y1 - y0)) * h));
  }

  /// Simulated seconds per second, smoothed.
  double speed() {
    const auto now = std::chrono::steady_clock::now();
    const double passed = std::chrono::duration<double>(now - shown_).count(), simulated = frame_->time - shown_time_;
    shown_ = now;
    shown_time_ = frame_->time;
    if (passed > 0 && simulated >= 0) speed_ += 0.1 * (simulated / passed - speed_);
    return speed_;
  }

  /// The worker computes what comes next while this frame is drawn; the window never waits for it.
  void simulate() {
    const bool scripted = o_.pull || o_.cut || o_.probe > 0 || o_.grasp > 0 || !o_.set.empty();
    constexpr double kFrame = 1.0 / 60;
    try {
      if (scripted) {
        use_script();
      } else {
        use_mouse();
      }
      const bool idle = !world_.busy();
      // With hands, what has passed since the last time; else the next sixtieth of a second.
      const double ahead = !idle ? 0 : hands_->empty() ? kFrame : hands_->passed(4 * kFrame);
      if (idle) {
        coloring_.update(world_, panel_->field());
        instruments_->fetch_shapes(frame_->time);
      }
      if (ahead > 0) instruments_->drive(ahead);
      if (!o_.screenshot.empty() && hands_->empty()) {
        world_.advance(kFrame);
        coloring_.update(world_, panel_->field());
      } else if (ahead > 0) {
        world_.advance_async(ahead);
      }
    } catch (const pliant::Error& error) {
      if (!o_.screenshot.empty()) throw;
      message_ = error.what();  // refused, or diverged: the last good state stays until R
    }
    frame_ = world_.frame();
  }

  Options o_;
  pliant::World world_;
  pliant::FramePtr frame_;
  std::unique_ptr<Hands> hands_;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<Drawing> drawing_;
  std::unique_ptr<Panel> panel_;
  std::unique_ptr<Instruments> instruments_;
  Coloring coloring_;
  Orbit camera_;
  float ground_ = 0, start_distance_ = 1, size_ = 1;
  float scrolled_ = 0, surface_ = 1, sent_ = 0;
  std::vector<int> pressed_;  ///< keys since the last frame
  std::string message_;
  std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
  double shown_time_ = 0, speed_ = 0;
  pliant::GrabId held_ = 0;
  Vec3 held_from_{};
  std::int32_t poked_ = -1;
  bool cutting_ = false;
  double last_x_ = 0, last_y_ = 0;
};

}  // namespace
}  // namespace window

int main(int argc, char** argv) try {
  return window::Window(window::read(argc, argv)).run();
} catch (const std::exception& error) {
  std::fprintf(stderr, "window: %s\n", error.what());
  return 2;
}
