#include "panel.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "drawing.h"

namespace window {
namespace {

std::string text_of(const Slider& slider) {
  char number[32];
  std::snprintf(number, sizeof number, "%.9g", static_cast<double>(slider.value));
  return slider.before + number + slider.after;
}

void add_gravity(const nlohmann::json& scene, std::vector<Slider>& sliders) {
  const auto given = scene.value("gravity", nlohmann::json::array({0, 0, 0}));
  if (!given.is_array()) return;  // with a curve
  std::array<double, 3> g{};
  double size = 0;
  for (std::size_t c = 0; c < 3; ++c) size += std::pow(g[c] = given[c].get<double>(), 2);
  // Along one axis one number can change it.
  const auto axis = static_cast<std::size_t>(
      std::max_element(g.begin(), g.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) - g.begin());
  if (size > 0 && std::abs(g[axis]) < 0.999 * std::sqrt(size)) return;
  const std::size_t along = size > 0 ? axis : 1;
  std::string before = "{\"gravity\": [", after;
  for (std::size_t c = 0; c < along; ++c) before += "0, ";
  for (std::size_t c = along + 1; c < 3; ++c) after += ", 0";
  constexpr const char* names[] = {"gravity x", "gravity y", "gravity z"};
  sliders.push_back({names[along], before, after + "]}", static_cast<float>(g[along]), -20, 20, false});
}

/// `part`: "material" or "model".
void add(const nlohmann::json& body, const std::string& name, const char* part, const char* key, float low, float high,
         bool logarithmic, std::vector<Slider>& sliders) {
  if (!body.contains(part) || !body[part].contains(key) || !body[part][key].is_number()) return;
  const auto value = body[part][key].get<float>();
  Slider slider{std::string(key) + " of " + name,
                "{\"body\": " + nlohmann::json(name).dump() + ", \"" + part + "\": {\"" + key + "\": ",
                "}}",
                value,
                low,
                high,
                logarithmic};
  if (logarithmic) slider.low = value / 10, slider.high = value * 10;
  slider.high = std::max(slider.high, value);
  sliders.push_back(slider);
}

}  // namespace

std::vector<Slider> sliders_of(const std::string& scene_file) {
  std::vector<Slider> sliders;
  const nlohmann::json scene = nlohmann::json::parse(std::ifstream(scene_file), nullptr, true, true);
  add_gravity(scene, sliders);
  int bodies = 0;
  for (const nlohmann::json& body : scene["bodies"]) {
    const std::string name = body.value("name", "body" + std::to_string(bodies));
    if (++bodies > 4) break;
    add(body, name, "material", "young", 0, 0, true, sliders);
    add(body, name, "material", "damping", 0, 100, false, sliders);
    add(body, name, "model", "alpha", 0.05F, 1, false, sliders);
    add(body, name, "model", "ratio", 0.05F, 1, false, sliders);
  }
  return sliders;
}

Panel::Panel(GLFWwindow* window, std::vector<Slider> sliders) : sliders_(std::move(sliders)), first_(sliders_) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
  ImGui::StyleColorsLight();
  ImGui::GetStyle().WindowRounding = 4;
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Panel::~Panel() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Panel::takes_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Panel::takes_keys() const { return ImGui::GetIO().WantCaptureKeyboard; }

std::string Panel::set(const std::string& label, float value) {
  const auto found = std::find_if(sliders_.begin(), sliders_.end(), [&](const Slider& s) { return s.label == label; });
  if (found == sliders_.end()) return {};
  found->value = value;
  return text_of(*found);
}

void Panel::choose_color(const std::string& field) {
  const auto found = std::find_if(kColors.begin(), kColors.end(), [&](const ColorChoice& c) { return field == c.field; });
  if (found == kColors.end()) throw std::runtime_error("--color: there is no field '" + field + "'");
  color = static_cast<int>(found - kColors.begin());
}

void Panel::show_colors(float most) {
  ImGui::Combo(
      "colour", &color,
      [](void*, int i, const char** text) { return (*text = kColors[static_cast<std::size_t>(i)].label, true); }, nullptr,
      static_cast<int>(kColors.size()));
  if (color == 0) return;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  constexpr float kWide = 160 / 4.0F, kHigh = 12;
  for (std::size_t i = 0; i + 1 < kRamp.size(); ++i) {
    const auto shade = [&](std::size_t k) { return ImGui::GetColorU32({kRamp[k][0], kRamp[k][1], kRamp[k][2], 1}); };
    const float left = corner.x + kWide * static_cast<float>(i);
    ImGui::GetWindowDrawList()->AddRectFilledMultiColor({left, corner.y}, {left + kWide, corner.y + kHigh}, shade(i),
                                                        shade(i + 1), shade(i + 1), shade(i));
  }
  ImGui::Dummy({160, kHigh});
  ImGui::Text("0 to %.3g %s", static_cast<double>(most), kColors[static_cast<std::size_t>(color)].unit);
}

void Panel::show_parameters(PanelChoice& choice) {
  if (ImGui::CollapsingHeader("Parameters", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (Slider& s : sliders_) {
      ImGui::SliderFloat(s.label.c_str(), &s.value, s.low, s.high, "%.4g", s.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
      if (ImGui::IsItemDeactivatedAfterEdit()) choice.changes.push_back(text_of(s));
    }
  }
  if (ImGui::CollapsingHeader("Keys")) {
    ImGui::TextUnformatted(
        "without an instrument: the left button pulls, with\n"
        "Control it cuts; Space pokes\n"
        "instrument: the mouse moves it, the wheel pushes it\n"
        "deeper, Shift turns it (wheel: about its view);\n"
        "arrows, PageUp and PageDown do the same\n"
        "grasper: left button closes it\n"
        "right button: turn the view; Control and wheel: nearer");
  }
}

PanelChoice Panel::show(const PanelState& state) {
  PanelChoice choice;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.85F);
  ImGui::Begin("Pliant", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushItemWidth(160);
  ImGui::Text("%.2f s, %.2f of real time", state.time, state.real_time);
  // One row of instruments; the held one is pressed.
  const bool hand = state.active >= state.instruments.size();
  choice.hand = ImGui::RadioButton("pull, cut, poke (0)", hand);
  for (std::size_t i = 0; i < state.instruments.size(); ++i) {
    char label[160];
    std::snprintf(label, sizeof label, i < 9 ? "%s (%zu)" : "%s", state.instruments[i].c_str(), i + 1);
    if (ImGui::RadioButton(label, state.active == i)) choice.instrument = static_cast<int>(i);
  }
  choice.probe = ImGui::Button("probe (P)");
  ImGui::SameLine();
  choice.grasper = ImGui::Button("grasper (G)");
  ImGui::SameLine();
  choice.reset = ImGui::Button("start again (R)");
  ImGui::SliderFloat("depth of the blade", &depth, 0.02F, 1, depth >= 1 ? "through" : "%.2f of the size");
  const auto force = static_cast<float>(state.force);
  most_ = std::max(most_, force);
  trace_[next_] = force;
  next_ = (next_ + 1) % trace_.size();
  if (!hand) {
    char text[48];
    std::snprintf(text, sizeof text, "%.3g N", state.force);
    ImGui::ProgressBar(most_ > 0 ? force / most_ : 0, {160, 0}, text);
    ImGui::SameLine();
    ImGui::TextUnformatted("force");
    std::snprintf(text, sizeof text, "up to %.3g N", static_cast<double>(most_));
    ImGui::PlotLines("##trace", trace_.data(), static_cast<int>(trace_.size()), static_cast<int>(next_), text, 0,
                     std::max(most_, 1e-6F), {240, 60});
  }
  for (const std::string& line : state.hands) ImGui::TextUnformatted(line.c_str());
  show_colors(state.most);
  show_parameters(choice);
  if (!state.message.empty()) {
    ImGui::PushTextWrapPos(260);
    ImGui::TextColored({0.7F, 0.1F, 0.05F, 1}, "%s", state.message.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::PopItemWidth();
  ImGui::End();
  ImGui::Render();
  return choice;
}

void Panel::draw() const { ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData()); }

}  // namespace window
