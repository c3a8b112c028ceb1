#include "scene/keys.h"

#include <algorithm>
#include <cctype>
#include <numeric>

#include "scene/described_keys.h"

namespace pliant {

namespace {

using List = std::vector<std::string>;

List operator+(List a, const List& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Those that `describe` describes of a T.
template <class T, class Describe>
List described(const Describe& describe) {
  List names;
  const T object{};
  describe(ListKeys{names}, object);
  return names;
}
#define PLIANT_DESCRIBED(type, what) described<type>([](auto v, const auto& object) { describe_##what(v, object); })

std::map<std::string, List> make_keys() {
  const List points{"box", "sphere", "plane", "surface", "region", "data", "dimension", "all"};
  const List selection = points + List{"nodes"};
  const List curve = PLIANT_DESCRIBED(Curve, curve) + List{"table"};
  return {
      {"scene", PLIANT_DESCRIBED(Scene, scene) + PLIANT_DESCRIBED(Scene, run) +
                    List{"format", "name", "gravity", "relaxation", "solver", "focus", "tools", "contact", "blades", "view",
                         "probes", "probe_every", "bodies", "joins", "changes"}},
      {"body", List{"name", "surface", "mesh", "lattice", "material", "membrane", "vessels", "springs", "model", "inclusions",
                    "fixed", "prescribed", "forces", "pressures", "initial"} +
                   PLIANT_DESCRIBED(Body, body)},
      {"lattice", PLIANT_DESCRIBED(LatticeSpec, lattice)},
      {"membrane", PLIANT_DESCRIBED(Membrane, membrane)},
      {"vessel", List{"points", "segments"} + PLIANT_DESCRIBED(Vessel, vessel)},
      {"material", List{"law"} + elastic_keys() + PLIANT_DESCRIBED(Material, material)},
      {"model", PLIANT_DESCRIBED(DeformationModel, type) + hybrid_keys() + matching_keys() + List{"spring"} +
                    PLIANT_DESCRIBED(DeformationModel, network)},
      {"spring", PLIANT_DESCRIBED(Spring, spring) + List{"table"}},
      {"spring_list", List{"nodes", "file", "spring"}},
      {"join", List{"bodies", "spring"} + PLIANT_DESCRIBED(Join, join)},
      {"region", {"box", "sphere"}},
      {"element_field", {"field"}},
      {"stiffness", PLIANT_DESCRIBED(DeformationModel, stiffness)},
      {"gravity", PLIANT_DESCRIBED(Scene, gravity) + curve},
      {"focus", {"path"}},
      {"contact_tool", List{"name", "shape", "path", "contact", "grip"} + PLIANT_DESCRIBED(ContactTool, tool)},
      {"shape", words_only(tool_shape_words())},
      {"contact", PLIANT_DESCRIBED(ContactTool, contact_law)},
      {"tissue_contact", PLIANT_DESCRIBED(TissueContact, friction)},
      {"change", PLIANT_DESCRIBED(ChangePlace, change) + List{"gravity", "material", "model", "fixed"}},
      {"grip", List{"times"} + PLIANT_DESCRIBED(GripSpec, grip)},
      {"blade", List{"name", "path"} + PLIANT_DESCRIBED(Blade, blade)},
      {"view", PLIANT_DESCRIBED(SceneView, view)},
      {"relaxation", PLIANT_DESCRIBED(Relaxation, relaxation)},
      {"solver", PLIANT_DESCRIBED(StaticSolver, solver)},
      {"inclusion", points + List{"material"}},
      {"fixed", selection + PLIANT_DESCRIBED(Fixed, axes)},
      {"prescribed", selection + List{"displacement", "rotate"} + PLIANT_DESCRIBED(Prescribed, axes) + curve},
      {"probe", selection + List{"name", "body", "between", "quantities"} + PLIANT_DESCRIBED(SceneProbe, place)},
      {"probe_every", PLIANT_DESCRIBED(SceneProbes, pace)},
      {"rotation", PLIANT_DESCRIBED(Rotation, rotation)},
      {"initial", selection + List{"velocity", "displacement"}},
      {"field", PLIANT_DESCRIBED(AffineField, field)},
      {"force", selection + PLIANT_DESCRIBED(Force, force) + curve},
      {"pressure", points + PLIANT_DESCRIBED(Pressure, pressure) + curve},
  };
}

/// Levenshtein distance, case-insensitive; keys are short, so the quadratic table does not matter.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row.back();
}

}  // namespace

List moduli_keys() { return PLIANT_DESCRIBED(ElasticConstants, elastic); }

List elastic_keys(const LawInfo& law) {
  if (law.takes_moduli) return moduli_keys();
  List keys;
  for (const ParameterInfo& p : law.parameters) keys.emplace_back(p.name);
  return keys;
}

List elastic_keys() {
  List keys = moduli_keys();
  for (const Law law : all_laws()) {
    for (const std::string& key : elastic_keys(law_info(law))) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
  }
  return keys;
}

List growth_keys() { return PLIANT_DESCRIBED(DeformationModel, growth); }

List hybrid_keys() { return growth_keys() + List{"region"} + PLIANT_DESCRIBED(DeformationModel, interface); }

List matching_keys() {
  return PLIANT_DESCRIBED(DeformationModel, regions) + PLIANT_DESCRIBED(DeformationModel, alpha) + List{"stiffness"};
}

std::string laws_with(bool LawInfo::*property) {
  List words;
  for (const Law law : all_laws()) {
    if (law_info(law).*property) words.emplace_back(to_string(law));
  }
  return alternatives(words);
}

std::string elements_with(const std::function<bool(const ElementInfo&)>& has) {
  List words;
  for (const ElementKind kind : all_elements()) {
    if (has(element_info(kind))) words.emplace_back(to_string(kind));
  }
  return alternatives(words);
}

const std::map<std::string, List>& scene_keys() {
  static const std::map<std::string, List> keys = make_keys();
  return keys;
}

const Words<Law>& law_words() {
  static const Words<Law> words = [] {
    Words<Law> list;
    for (const Law law : all_laws()) list.push_back({to_string(law), law, law_info(law).energy});
    return list;
  }();
  return words;
}

const Words<ElementKind>& element_words() {
  static const Words<ElementKind> words = [] {
    Words<ElementKind> list;
    for (const ElementKind kind : all_elements()) list.push_back({to_string(kind), kind, element_info(kind).what});
    return list;
  }();
  return words;
}

const Words<Curve::Kind>& curve_words() {
  static const Words<Curve::Kind> words{{"constant", Curve::Kind::constant, "1 from the start on"},
                                        {"ramp", Curve::Kind::ramp, "linear from 0 to 1"},
                                        {"smooth", Curve::Kind::smooth, "10 s^3 - 15 s^4 + 6 s^5"},
                                        {"table", Curve::Kind::table, "linear between rows"}};
  return words;
}

const Words<Integrator>& integrator_words() {
  static const Words<Integrator> words = [] {
    Words<Integrator> list;
    for (const Integrator i : all_integrators()) list.push_back({integrator_info(i).word, i, integrator_info(i).what});
    return list;
  }();
  return words;
}

const Words<Inverted>& inverted_words() {
  static const Words<Inverted> words{{"recover", Inverted::recover, "goes on and is driven back; counted"},
                                     {"stop", Inverted::stop, "ends the run, as a divergence"}};
  return words;
}

const Words<BladeCuts>& blade_cuts_words() {
  static const Words<BladeCuts> words{{"always", BladeCuts::always, "all that it sweeps over"},
                                      {"by-force", BladeCuts::by_force, "what gives way to the force of its edge"}};
  return words;
}

const Words<BladeMethod>& blade_method_words() {
  static const Words<BladeMethod> words{
      {"virtual-nodes", BladeMethod::virtual_nodes, "the elements that it crosses become copies, one for each side"},
      {"separation", BladeMethod::separation, "elements part along the faces nearest to what it sweeps; none is added"},
      {"decomposition", BladeMethod::decomposition, "tetrahedra that it crosses are divided into smaller ones"},
      {"removal", BladeMethod::removal, "elements that it touches go, and their mass with them"}};
  return words;
}

const Words<ToolShape>& tool_shape_words() {
  static const Words<ToolShape> words{{"sphere", ToolShape::sphere, "about the origin"},
                                      {"capsule", ToolShape::capsule, "a segment with a radius"},
                                      {"box", ToolShape::box, "about the origin"},
                                      {"half_space", ToolShape::half_space, "all below a plane"},
                                      {"mesh", ToolShape::mesh, "what a closed surface encloses"},
                                      {"sequence", ToolShape::sequence, "a closed surface per frame"}};
  return words;
}

const Words<bool>& solver_words() {
  static const Words<bool> words{{"dynamic", false, "steps in time"}, {"static", true, "equilibrium"}};
  return words;
}

const Words<ModelType>& model_words() {
  static const Words<ModelType> words{{"tled", ModelType::tled, "finite elements"},
                                      {"hybrid", ModelType::hybrid, "finite elements in the operational region"},
                                      {"flsm", ModelType::flsm, "shape matching"},
                                      {"mass-spring", ModelType::mass_spring, "springs along the edges of tetrahedra"}};
  return words;
}

const Words<SpringLaw>& spring_law_words() {
  static const Words<SpringLaw> words{{"linear", SpringLaw::linear, "F = k e"},
                                      {"cubic", SpringLaw::cubic, "F = lambda1 (e / l0)^3 + lambda2 e / l0"},
                                      {"measured", SpringLaw::measured, "F = e / (a abs(e) + b)"},
                                      {"table", SpringLaw::curve, "linear between rows"}};
  return words;
}

const Words<bool>& goals_words() {
  static const Words<bool> words{{"held", false, "in the first of the substeps"}, {"extrapolated", true, "in all of them"}};
  return words;
}

const Words<bool>& coupling_words() {
  static const Words<bool> words{{"conservative", true, "with the reaction of the interface"}, {"one-sided", false, "without"}};
  return words;
}

const Words<Quantity>& quantity_words() {
  static const Words<Quantity> words{{"position", Quantity::position, "where it is"},
                                     {"displacement", Quantity::displacement, "from where it was at rest"},
                                     {"velocity", Quantity::velocity, "of the material"},
                                     {"stress", Quantity::stress, "Cauchy stress at a point"},
                                     {"green_strain", Quantity::green_strain, "Green-Lagrange strain at a point"},
                                     {"almansi_strain", Quantity::almansi_strain, "Almansi strain at a point"},
                                     {"reaction", Quantity::reaction, "force that fixes or moves nodes, summed"},
                                     {"force", Quantity::force, "applied loads on nodes, summed"},
                                     {"energy", Quantity::energy, "kinetic, and of the strain"},
                                     {"interpenetration", Quantity::interpenetration, "what two things have in common"}};
  return words;
}

std::string nearest(const std::string& text, const List& words) {
  if (text.size() > 64) return "";
  std::string best;
  std::size_t least = 0;
  for (const std::string& word : words) {
    const std::size_t distance = edit_distance(text, word);
    if (2 * distance > std::max(text.size(), word.size())) continue;
    if (best.empty() || distance < least) {
      best = word;
      least = distance;
    }
  }
  return best;
}

std::string listed(const List& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string alternatives(const List& words) {
  if (words.size() < 2) return listed(words);
  return listed({words.begin(), words.end() - 1}) + " or " + words.back();
}

}  // namespace pliant
