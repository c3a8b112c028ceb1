#include "statics/system.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/parallel.h"
#include "pliant/error.h"

namespace pliant::statics {

/// Where the products of prescribed changes and stiffness go.
struct System::Sink {
  const VectorXd* moved = nullptr;
  VectorXd* force = nullptr;
};

System::System(const Problem& problem, bool linear) : problem_(problem), linear_(linear) {
  check();
  number();
  precompute();
  add_dead_loads();
  patches_ = pressure_patches(problem_);
  make_pattern();
}

void System::check() const {
  const Mesh& mesh = problem_.mesh;
  const auto nodes = static_cast<std::int32_t>(mesh.nodes.size());
  const auto fail = [](const std::string& text) { throw Error(ErrorCode::bad_input, "static problem: " + text); };
  const auto check_node = [&](std::int32_t n, const char* where) {
    if (n < 0 || n >= nodes) fail(fmt::format("{} names node {}, allowed are 0 to {}", where, n, nodes - 1));
  };
  if (mesh.corners.empty()) fail("the mesh has no element");
  if (mesh.corners.size() % corners_of(mesh.element) != 0) fail("the number of corners is no multiple of an element's");
  std::vector<char> used(mesh.nodes.size(), 0);
  for (const std::int32_t n : mesh.corners) {
    check_node(n, "an element");
    used[n] = 1;
  }
  const auto lost = std::find(used.begin(), used.end(), 0);
  if (lost != used.end()) fail(fmt::format("node {} belongs to no element", lost - used.begin()));
  const auto per_element = [&](std::size_t got, const char* what) {
    if (got != 0 && got != static_cast<std::size_t>(mesh.elements()))
      fail(fmt::format("{} {} for {} elements", got, what, mesh.elements()));
  };
  per_element(mesh.material.size(), "materials");
  per_element(mesh.fill.size(), "fills");
  if (problem_.materials.empty()) fail("no material");
  for (const int m : mesh.material) {
    if (m < 0 || m >= static_cast<int>(problem_.materials.size()))
      fail(fmt::format("an element has material {}, allowed are 0 to {}", m, problem_.materials.size() - 1));
  }
  for (const Prescribed& p : problem_.prescribed) {
    check_node(p.node, "a prescribed displacement");
    if (p.axis < 0 || p.axis > 2) fail(fmt::format("a prescribed displacement has axis {}, allowed are 0 to 2", p.axis));
  }
  for (const Force& f : problem_.forces) check_node(f.node, "a force");
  for (const SurfacePoint& p : problem_.surface) {
    for (const std::int32_t n : p.nodes) check_node(n, "a surface point");
  }
  for (const Pressure& p : problem_.pressures) {
    for (const std::int32_t v : p.points) {
      if (v < 0 || v >= static_cast<std::int32_t>(problem_.surface.size()))
        fail(fmt::format("a pressure names surface point {}, allowed are 0 to {}", v,
                         static_cast<std::int64_t>(problem_.surface.size()) - 1));
    }
  }
  const int corners = mesh.element == Element::hex8full ? 8 : 4;
  for (const FacePressure& p : problem_.face_pressures) {
    if (p.element < 0 || p.element >= mesh.elements())
      fail(fmt::format("a pressure names element {}, allowed are 0 to {}", p.element, mesh.elements() - 1));
    for (const int c : p.corners) {
      if (c < 0 || c >= corners) fail(fmt::format("a pressure names corner {}, allowed are 0 to {}", c, corners - 1));
    }
  }
}

void System::number() {
  check_held(problem_);
  free_.assign(components(), 0);
  prescribed_ = VectorXd::Zero(components());
  for (const Prescribed& p : problem_.prescribed) {
    free_[3 * p.node + p.axis] = -1;
    prescribed_[3 * p.node + p.axis] = p.displacement;
  }
  for (int& f : free_) f = f < 0 ? -1 : unknowns_++;
}

void System::precompute() {
  const Mesh& mesh = problem_.mesh;
  const auto& rule = quadrature(mesh.element);
  points_.resize(mesh.elements() * rule.size());
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    const Gradients x = corners_at(mesh, e);
    for (std::size_t p = 0; p < rule.size(); ++p) {
      const Gradients local = shape_gradients(mesh.element, rule[p].at);
      const Matrix3d jacobian = x * local.transpose();
      const double determinant = jacobian.determinant();
      if (!(determinant > 0)) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("static problem: {} {} has volume {:.6g} m^3 at a point of quadrature, expected more than 0",
                                to_string(mesh.element), e, determinant * rule[p].weight));
      }
      Point& point = points_[e * rule.size() + p];
      point.gradient = jacobian.inverse().transpose() * local;
      point.weight = rule[p].weight * determinant * (mesh.fill.empty() ? 1 : mesh.fill[e]);
    }
  }
}

void System::add_dead_loads() {
  const Mesh& mesh = problem_.mesh;
  dead_ = VectorXd::Zero(components());
  for (const Force& f : problem_.forces) dead_.segment<3>(3 * f.node) += eigen(f.force);
  const Vector3d gravity = eigen(problem_.gravity);
  const bool weighs = gravity.squaredNorm() > 0, pulled = static_cast<bool>(problem_.body_force);
  if (!weighs && !pulled) return;
  // A force that varies in space wants a better rule than the stiffness, or it spoils the order of tet10.
  const auto& rule = pulled ? accurate_quadrature(mesh.element) : quadrature(mesh.element);
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    const Gradients x = corners_at(mesh, e);
    const double fill = mesh.fill.empty() ? 1 : mesh.fill[e];
    const double density = problem_.materials[mesh.material.empty() ? 0 : mesh.material[e]].density;
    for (const LocalPoint& p : rule) {
      const ShapeValues n = shape_values(mesh.element, p.at);
      const double weight = p.weight * fill * (x * shape_gradients(mesh.element, p.at).transpose()).determinant();
      Vector3d force = density * gravity;
      if (pulled) force += eigen(problem_.body_force(plain(x * n)));
      for (int a = 0; a < n.size(); ++a) dead_.segment<3>(3 * mesh.nodes_of(e)[a]) += weight * n[a] * force;
    }
  }
}

std::vector<int> System::components_of(const std::int32_t* nodes, int count) const {
  std::vector<int> components;
  for (int a = 0; a < count; ++a) {
    for (int c = 0; c < 3; ++c) components.push_back(3 * nodes[a] + c);
  }
  return components;
}

void System::make_pattern() {
  // Neighbouring nodes, node by node, then their free components: lower triangle, rows ascending.
  std::vector<std::vector<std::int32_t>> neighbors(problem_.mesh.nodes.size());
  const auto couple = [&](const std::int32_t* nodes, int count) {
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) neighbors[nodes[a]].push_back(nodes[b]);
    }
  };
  for (std::int64_t e = 0; e < problem_.mesh.elements(); ++e)
    couple(problem_.mesh.nodes_of(e), corners_of(problem_.mesh.element));
  for (const PressurePatch& patch : patches_) couple(patch.nodes.data(), static_cast<int>(patch.nodes.size()));
  std::vector<int> start(unknowns_ + 1, 0), rows;
  for (std::size_t n = 0; n < neighbors.size(); ++n) {
    auto& list = neighbors[n];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    for (int c = 0; c < 3; ++c) {
      const int column = free_[3 * n + c];
      if (column < 0) continue;
      for (const std::int32_t m : list) {
        for (int d = 0; d < 3; ++d) {
          if (const int row = free_[3 * m + d]; row >= column) rows.push_back(row);
        }
      }
      start[column + 1] = static_cast<int>(rows.size());
    }
    std::vector<std::int32_t>().swap(list);
  }
  const std::vector<double> zeros(rows.size(), 0);
  pattern_ = Eigen::Map<const SparseMatrix>(unknowns_, unknowns_, static_cast<int>(rows.size()), start.data(), rows.data(),
                                            zeros.data());
}

void System::scatter(const std::vector<int>& components, const Eigen::MatrixXd& block, SparseMatrix& stiffness,
                     Sink* sink) const {
  const auto count = static_cast<int>(components.size());
  std::vector<std::pair<int, int>> order;  // (free number, place in the block), ascending
  order.reserve(components.size());
  for (int i = 0; i < count; ++i) {
    if (const int f = free_[components[i]]; f >= 0) order.emplace_back(f, i);
  }
  std::sort(order.begin(), order.end());
  const int* const starts = stiffness.outerIndexPtr();
  const int* const rows = stiffness.innerIndexPtr();
  double* const values = stiffness.valuePtr();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto [column, at] = order[i];
    int place = starts[column];
    for (std::size_t k = i; k < order.size(); ++k) {
      while (rows[place] < order[k].first) ++place;
      values[place] += block(order[k].second, at);
    }
  }
  if (sink == nullptr || sink->moved == nullptr) return;
  for (int i = 0; i < count; ++i) {
    const double moved = (*sink->moved)[components[i]];
    if (free_[components[i]] >= 0 || moved == 0) continue;
    for (const auto& [row, at] : order) (*sink->force)[row] += block(at, i) * moved;
  }
}

void System::compute(std::int64_t e, const VectorXd& u, bool with_stiffness, Contribution& out) const {
  const Mesh& mesh = problem_.mesh;
  const int count = corners_of(mesh.element);
  const auto per_element = static_cast<std::int64_t>(quadrature(mesh.element).size());
  const Material& material = problem_.materials[mesh.material.empty() ? 0 : mesh.material[e]];
  Gradients moved(3, count);
  for (int a = 0; a < count; ++a) moved.col(a) = u.segment<3>(3 * mesh.nodes_of(e)[a]);
  out.force.setZero(3 * count);
  out.size.setZero(3 * count);
  if (with_stiffness) out.stiffness.setZero(3 * count, 3 * count);
  out.energy = 0;
  out.good = true;
  Response response;
  Eigen::Matrix<double, 9, Eigen::Dynamic, Eigen::ColMajor, 9, 3 * kMostCorners> b(9, 3 * count);
  for (std::int64_t p = 0; p < per_element; ++p) {
    const Point& point = points_[e * per_element + p];
    const Matrix3d h = moved * point.gradient.transpose();
    if (linear_) {
      respond_linear(material, h, response);
    } else if (!respond(material, h, with_stiffness, response)) {
      out.good = false;
      return;
    }
    out.energy += point.weight * response.energy;
    const Gradients force = point.weight * response.stress * point.gradient;
    out.force += force.reshaped();
    out.size += force.cwiseAbs().reshaped();
    if (!with_stiffness) continue;
    b.setZero();
    for (int a = 0; a < count; ++a) {
      for (int i = 0; i < 3; ++i) b.block<3, 1>(3 * i, 3 * a + i) = point.gradient.col(a);
    }
    out.stiffness.noalias() += b.transpose() * (point.weight * response.tangent * b);
  }
}

double System::largest_gradient(const VectorXd& d) const {
  const Mesh& mesh = problem_.mesh;
  const int count = corners_of(mesh.element);
  const auto per_element = static_cast<std::int64_t>(quadrature(mesh.element).size());
  double largest = 0;
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    Gradients moved(3, count);
    for (int a = 0; a < count; ++a) moved.col(a) = d.segment<3>(3 * mesh.nodes_of(e)[a]);
    for (std::int64_t p = 0; p < per_element; ++p)
      largest = std::max(largest, (moved * points_[e * per_element + p].gradient.transpose()).norm());
  }
  return largest;
}

bool System::evaluate(const VectorXd& u, double load, Forces& out, SparseMatrix* stiffness, Sink* sink) const {
  const Mesh& mesh = problem_.mesh;
  const int count = corners_of(mesh.element);
  out.internal = VectorXd::Zero(components());
  out.external = load * dead_;
  out.energy = 0;
  if (stiffness != nullptr) std::fill_n(stiffness->valuePtr(), stiffness->nonZeros(), 0.0);
  VectorXd size = VectorXd::Zero(components());
  // Elements in parallel, sums in their order: the result does not depend on the threads.
  constexpr std::int64_t kChunk = 2048, kSlice = 64;
  std::vector<Contribution> chunk(static_cast<std::size_t>(std::min(kChunk, mesh.elements())));
  for (std::int64_t first = 0; first < mesh.elements(); first += kChunk) {
    const std::int64_t in_chunk = std::min(kChunk, mesh.elements() - first);
    parallel_for((in_chunk + kSlice - 1) / kSlice, [&](std::int64_t slice) {
      for (std::int64_t i = slice * kSlice; i < std::min(in_chunk, (slice + 1) * kSlice); ++i)
        compute(first + i, u, stiffness != nullptr, chunk[i]);
    });
    for (std::int64_t i = 0; i < in_chunk; ++i) {
      const Contribution& element = chunk[i];
      if (!element.good) return false;
      const std::int32_t* const nodes = mesh.nodes_of(first + i);
      for (int a = 0; a < count; ++a) {
        out.internal.segment<3>(3 * nodes[a]) += element.force.segment<3>(3 * a);
        size.segment<3>(3 * nodes[a]) += element.size.segment<3>(3 * a);
      }
      out.energy += element.energy;
      if (stiffness != nullptr) scatter(components_of(nodes, count), element.stiffness, *stiffness, sink);
    }
  }
  out.sum_of_sizes = size.norm();
  add_pressures(u, load, out, stiffness, sink);
  return std::isfinite(out.energy);
}

bool System::tangent(const VectorXd& u, double load, Forces& out, SparseMatrix& stiffness, VectorXd* moved_force,
                     const VectorXd* moved) const {
  Sink sink{moved, moved_force};
  if (moved_force != nullptr) *moved_force = VectorXd::Zero(unknowns_);
  return evaluate(u, load, out, &stiffness, &sink);
}

// The tangent takes the symmetric part of what the pressures add, so that Newton's method stays a Cholesky method; the solver
// adds the other part by iteration (skew_product).
void System::add_pressures(const VectorXd& u, double load, Forces& out, SparseMatrix* stiffness, Sink* sink) const {
  for (const PressurePatch& patch : patches_) {
    Eigen::Matrix3Xd moved = patch.of(u);
    if (linear_) moved.setZero();
    const Eigen::Matrix3Xd force = load * patch.forces(moved);
    for (std::size_t a = 0; a < patch.nodes.size(); ++a)
      out.external.segment<3>(3 * patch.nodes[a]) += force.col(static_cast<Eigen::Index>(a));
    if (stiffness == nullptr || linear_) continue;
    scatter(components_of(patch.nodes.data(), static_cast<int>(patch.nodes.size())), load * patch.stiffness(moved), *stiffness,
            sink);
  }
}

VectorXd System::skew_product(const VectorXd& u, double load, const VectorXd& d) const {
  VectorXd out = VectorXd::Zero(components());
  for (const PressurePatch& patch : patches_) {
    const Eigen::Matrix3Xd product = load * patch.skew_product(patch.of(u), patch.of(d));
    for (std::size_t a = 0; a < patch.nodes.size(); ++a)
      out.segment<3>(3 * patch.nodes[a]) += product.col(static_cast<Eigen::Index>(a));
  }
  return free_part(out);
}

VectorXd System::free_part(const VectorXd& all) const {
  VectorXd out(unknowns_);
  for (int i = 0; i < components(); ++i) {
    if (free_[i] >= 0) out[free_[i]] = all[i];
  }
  return out;
}

VectorXd System::spread(const VectorXd& free_values) const {
  VectorXd out = VectorXd::Zero(components());
  for (int i = 0; i < components(); ++i) {
    if (free_[i] >= 0) out[i] = free_values[free_[i]];
  }
  return out;
}

}  // namespace pliant::statics
