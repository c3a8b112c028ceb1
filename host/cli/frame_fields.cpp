#include "cli/frame_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "cli/option_word.h"
#include "model/elements/each_element.h"
#include "simulation/measure/surface_fields.h"

namespace pliant::cli {
namespace {

/// What the arrays of a field are called in files.
std::string name_of(FrameField field) {
  return field == FrameField::pressure ? "contact_pressure" : word_of(field_words(), field);
}

/// The same field of the surface; none for one that only elements have.
std::optional<ColorBy> on_surface(FrameField field) {
  if (field == FrameField::stress) return std::nullopt;
  return color_by(word_of(field_words(), field));
}

void append(std::vector<float>& values, FrameField field, const Strain& s) {
  switch (field) {
    case FrameField::mises:
      return values.push_back(static_cast<float>(s.mises));
    case FrameField::stress:
      for (const double c : s.stress) values.push_back(static_cast<float>(c));
      return;
    case FrameField::green_strain:
      return values.push_back(static_cast<float>(s.green));
    case FrameField::almansi_strain:
      return values.push_back(static_cast<float>(s.almansi));
    case FrameField::energy:
      return values.push_back(static_cast<float>(s.energy));
    case FrameField::pressure:
    case FrameField::model:
      return;
  }
}

/// Body by body: 1 for a finite element, 0 for a cell of shape matching.
std::vector<std::vector<float>> finite_elements(const Model& model) {
  std::vector<std::vector<float>> out;
  for (const ModelBody& b : model.bodies) out.emplace_back(static_cast<std::size_t>(b.elements()), 0.0F);
  for_each_element(model,
                   [&](const ElementView& e) { out[static_cast<std::size_t>(e.body)][static_cast<std::size_t>(e.id)] = 1; });
  return out;
}

}  // namespace

const Words<FrameField>& field_words() {
  static const Words<FrameField> words{
      {"mises", FrameField::mises, "von Mises stress [Pa]"},
      {"stress", FrameField::stress, "Cauchy stress xx, yy, zz, xy, yz, xz of the elements [Pa]"},
      {"green_strain", FrameField::green_strain, "equivalent Green strain"},
      {"almansi_strain", FrameField::almansi_strain, "equivalent Almansi strain"},
      {"energy", FrameField::energy, "strain energy per rest volume [J/m^3]"},
      {"pressure", FrameField::pressure, "contact pressure on the surface [Pa]"},
      {"model", FrameField::model, "finite elements or shape matching"}};
  return words;
}

std::vector<FrameField> parse_fields(const std::vector<std::string>& words) {
  std::vector<FrameField> fields;
  for (const std::string& word : words) {
    const FrameField field = value_of("--fields", word, field_words());
    if (std::find(fields.begin(), fields.end(), field) == fields.end()) fields.push_back(field);
  }
  return fields;
}

std::vector<VtuArray> element_fields(const Simulation& simulation, const std::vector<FrameField>& fields) {
  const auto of_strain = [](FrameField f) { return f != FrameField::pressure && f != FrameField::model; };
  const bool strains = std::any_of(fields.begin(), fields.end(), of_strain);
  const Model& model = simulation.model();
  std::array<std::vector<std::vector<float>>, 2> of_kind;  // tetrahedra, hexahedra: by field
  of_kind.fill(std::vector<std::vector<float>>(fields.size()));
  std::vector<std::vector<float>> finite;
  if (std::find(fields.begin(), fields.end(), FrameField::model) != fields.end()) finite = finite_elements(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    std::vector<std::vector<float>>& out = of_kind[body.tets.empty() ? 1 : 0];
    ElementStrains of_body;
    if (strains) of_body = element_strains(simulation.scene().bodies[b], body, simulation.displacements(b));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i] == FrameField::model) out[i].insert(out[i].end(), finite[b].begin(), finite[b].end());
      for (const Strain& s : of_body.strain) append(out[i], fields[i], s);
    }
  }
  std::vector<VtuArray> arrays;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i] == FrameField::pressure) continue;
    VtuArray& array = arrays.emplace_back(VtuArray{name_of(fields[i]), fields[i] == FrameField::stress ? 6 : 1, {}});
    for (const auto& part : of_kind) array.values.insert(array.values.end(), part[i].begin(), part[i].end());
  }
  return arrays;
}

std::vector<VtuArray> vertex_fields(const Simulation& simulation, const std::vector<FrameField>& fields) {
  std::vector<VtuArray> arrays;
  for (const FrameField field : fields) {
    const std::optional<ColorBy> by = on_surface(field);
    if (!by) continue;
    if (*by == ColorBy::model) {
      arrays.push_back({name_of(field), 3, vertex_kinds(simulation.model())});
    } else {
      arrays.push_back({name_of(field), 1, vertex_values(simulation, *by)});
    }
  }
  return arrays;
}

}  // namespace pliant::cli
