// What the window shows beside the bodies: instruments, force, and sliders for the parameters of the scene.
#pragma once
#include <pliant/world.h>

#include <array>
#include <string>
#include <vector>

#include "gl.h"

namespace window {

/// A parameter of the scene that a slider changes.
struct Slider {
  std::string label;
  std::string before, after;  ///< of the change as text, around the value
  float value = 0, low = 0, high = 1;
  bool logarithmic = false;
};

/// The parameters that the scene file gives as numbers: gravity, and of the first four bodies modulus, damping, alpha and
/// ratio.
std::vector<Slider> sliders_of(const std::string& scene_file);

/// A field that the bodies can be coloured by (World::vertex_values).
struct ColorChoice {
  const char* field;  ///< empty: tissue
  const char* label;
  const char* unit;
};
inline constexpr std::array<ColorChoice, 7> kColors{{{"", "tissue", ""},
                                                     {"displacement", "displacement", "m"},
                                                     {"mises", "von Mises stress", "Pa"},
                                                     {"green_strain", "Green strain", ""},
                                                     {"energy", "strain energy density", "J/m3"},
                                                     {"pressure", "contact pressure", "Pa"},
                                                     {"finite_elements", "finite elements", ""}}};

/// What the panel shows in one frame.
struct PanelState {
  std::vector<std::string> instruments;
  std::vector<std::string> hands;  ///< a line for each haptic device
  std::size_t active = 0;          ///< beyond the last: the hand
  double force = 0, time = 0;
  double real_time = 0;  ///< simulated seconds per second
  float most = 0;        ///< largest value of the colours
  std::string message;   ///< of the last thing that was refused
};

/// What someone chose in the panel in one frame.
struct PanelChoice {
  int instrument = -1;  ///< -1: no choice
  bool hand = false, probe = false, grasper = false, reset = false;
  std::vector<std::string> changes;  ///< for World::parse_change()
};

class Panel {
 public:
  Panel(GLFWwindow* window, std::vector<Slider> sliders);
  ~Panel();
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  /// Lays out the panel.
  PanelChoice show(const PanelState& state);
  void draw() const;
  /// True while the mouse is over the panel, or a slider has the keys.
  [[nodiscard]] bool takes_mouse() const;
  [[nodiscard]] bool takes_keys() const;
  /// Moves a slider to `value`; returns the change, or nothing if no slider has this label.
  std::string set(const std::string& label, float value);
  /// Sliders at the values of the scene.
  void reset() { sliders_ = first_; }

  /// Chooses the colour by the name of its field. Throws std::runtime_error for another name.
  void choose_color(const std::string& field);
  [[nodiscard]] const char* field() const { return kColors[static_cast<std::size_t>(color)].field; }

  int color = 0;    ///< index in kColors
  float depth = 1;  ///< of the blade [sizes of the bodies]; 1: through everything

 private:
  void show_colors(float most);
  void show_parameters(PanelChoice& choice);

  std::vector<Slider> sliders_, first_;
  std::array<float, 240> trace_{};
  std::size_t next_ = 0;
  float most_ = 0;  ///< largest force so far [N]
};

}  // namespace window
