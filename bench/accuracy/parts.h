// The parts of `pliant bench accuracy`. A problem is one row of the table in problems.cpp; nothing else knows its
// name.
#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "backends/interface/timing.h"
#include "bench/accuracy/accuracy.h"
#include "simulation/simulation.h"
#include "statics/statics.h"

namespace pliant {
struct BodyMesh;
}

namespace pliant::bench::accuracy {

using Where = std::function<bool(const Vec3d&)>;

/// Nodes at these rest positions move by `displacement` (empty: not at all) in the components of `axes` (bit mask of x, y, z).
struct Support {
  Where where;
  int axes = 7;
  std::function<Vec3d(const Vec3d&)> displacement;
};

/// A dead traction [Pa at rest] on the faces whose centres are chosen; its resultant is exact even where a lattice is not.
struct Traction {
  Where where;
  Vec3d traction{};
  double width = 0;  ///< of the loaded strip: its area is this times the body's size along z [m]
};

enum class Shape { box, cook, liver };

/// What the bodies of all methods, and the mesh of the reference, are asked to do. SI units.
struct Problem {
  std::string name, title, lead;  ///< `lead`: a sentence on what it shows
  Shape shape = Shape::box;
  Vec3d size{};                   ///< of the box around the body [m]
  std::array<int, 3> cells{};     ///< of the coarsest body
  std::vector<int> refine;        ///< finer bodies have so many times the cells
  double characteristic = 0;      ///< "resolution" counts cells along this length [m]
  double young = 0, poisson = 0;  ///< neo-Hookean
  Vec3d gravity{};
  std::vector<Support> supports;
  std::vector<Traction> tractions;
  double omega = 0;            ///< lowest angular frequency, estimated: damping and loading follow it [rad/s]
  Vec3d seed{};                ///< the operational region of hybrids grows from here [m]
  std::vector<Vec3d> samples;  ///< where displacements are compared (rest positions) [m]; the liver's come with its surface
  std::string reference;       ///< what the exact answer is; empty: converge
  std::function<std::vector<Vec3d>(const Problem&)> exact;
  double exact_error = 0;                      ///< relative, of the exact answer as an answer to the three-dimensional problem
  int mirror = 0;                              ///< bit mask of axes: the answer is symmetric about the middle
  std::array<std::array<int, 3>, 2> levels{};  ///< cells of the reference's two meshes, counted over the whole body
  std::array<std::array<int, 3>, 2> quick_levels{};
};

constexpr double kDensity = 1000;  ///< of every body [kg/m^3]

/// The table; `scenes` holds the liver. With `quick` the bodies are coarse.
std::vector<Problem> problems(const std::filesystem::path& scenes, bool quick);

std::vector<Vec3d> exact_uniaxial(const Problem& p);
std::vector<Vec3d> exact_shear(const Problem& p);
std::vector<Vec3d> exact_column(const Problem& p);
std::vector<Vec3d> exact_elastica(const Problem& p);
constexpr double kStretch = 1.3, kShear = 0.3, kTipLoad = 1.5;  ///< kTipLoad: P L^2 / (E I)

struct Method {
  std::string name;
  ModelType type = ModelType::tled;
  ElementKind element = ElementKind::hex8;
  int width = 2;
  double ratio = 0;
};
std::vector<Method> methods(bool quick);

/// One point of the charts before it is measured.
struct Case {
  const Problem* problem = nullptr;
  const Method* method = nullptr;
  int refine = 1;
  std::string
      step;  ///< "0.9", "0.45": share of the stable or calibrated step; "1/60": as the screen, whatever stiffness that gives
  std::string backend;
  [[nodiscard]] std::string key() const;  ///< the name under which a finished point is kept
  [[nodiscard]] std::string text() const;
};

/// The displacements at the sample points, and what they are worth.
struct Reference {
  std::vector<Vec3d> u;    ///< [samples] [m]
  std::string text;        ///< what it is
  double error = 0;        ///< relative, estimated
  std::int64_t nodes = 0;  ///< of its finer mesh, 0 if exact
  double seconds = 0;
};
Reference make_reference(const Problem& problem, const std::filesystem::path& scenes);

/// A body of the engine with the problem's supports and loads.
struct Built {
  Scene scene;
  std::shared_ptr<const Model> model;
  statics::Mesh mesh;  ///< its nodes and elements, to interpolate in
  double spacing = 0;  ///< [m]
};
Built build(const Case& c, const std::filesystem::path& scenes);
/// A point of the box [0, size] where the problem's shape has it.
Vec3d shaped(const Problem& p, const Vec3d& x);
/// The time course of loads and prescribed displacements.
Curve load_curve(const Problem& p);
statics::Mesh mesh_of(const BodyMesh& solid);
/// The liver as hexahedra, `cells` of them along size[0].
statics::Mesh lattice_mesh(const Problem& p, int cells, const std::filesystem::path& scenes);

/// Let the body settle and time it. Members of the row that depend on the case alone, and its errors.
nlohmann::json measure(const Case& c, const Reference& reference, const std::filesystem::path& scenes, bool quick);

/// Adds "order" and "pareto" to the rows of one problem; errors below `floor` count as `floor`.
void add_order(nlohmann::json& rows, const nlohmann::json& problems);
void add_pareto(nlohmann::json& rows, const nlohmann::json& problems);

struct Errors {
  double l2 = 0, max = 0;  ///< relative
};
Errors errors_of(const std::vector<Vec3d>& u, const std::vector<Vec3d>& reference);

/// Points that fill a unit cube evenly (Halton's sequence in bases 2, 3, 5).
Vec3d halton(int index);

}  // namespace pliant::bench::accuracy
