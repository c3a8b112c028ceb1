#include "haptics/condensed.h"

#include <fmt/format.h>

#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant::haptics {
namespace {

using Eigen::MatrixXd;
using Eigen::SparseMatrix;
using Eigen::VectorXd;

/// Numbers of the components within contacts or others: [components]; others as -1 - number.
std::vector<int> numbers_of(int components, const std::vector<int>& contacts) {
  std::vector<int> number(static_cast<std::size_t>(components), -1);
  int last = -1;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c] <= last || contacts[c] >= components)
      throw Error(ErrorCode::bad_input, fmt::format("condense: contacts[{}] is {}, allowed are ascending numbers below {}", c,
                                                    contacts[c], components));
    last = contacts[c];
    number[static_cast<std::size_t>(last)] = static_cast<int>(c);
  }
  int others = 0;
  for (int& n : number) {
    if (n < 0) n = -1 - others++;
  }
  return number;
}

}  // namespace

Norton condense(const SparseMatrix<double>& stiffness, const std::vector<int>& contacts, const VectorXd& load) {
  const int components = static_cast<int>(stiffness.rows()), touched = static_cast<int>(contacts.size());
  if (stiffness.cols() != components || load.size() != components)
    throw Error(ErrorCode::bad_input, fmt::format("condense: a stiffness of {} x {} with a load of {}, allowed are equal sizes",
                                                  components, stiffness.cols(), load.size()));
  const std::vector<int> number = numbers_of(components, contacts);
  const int others = components - touched;
  std::vector<Eigen::Triplet<double>> inner;
  MatrixXd across = MatrixXd::Zero(others, touched);
  Norton norton{MatrixXd::Zero(touched, touched), VectorXd::Zero(touched)};
  for (int column = 0; column < components; ++column) {
    const int j = number[static_cast<std::size_t>(column)];
    for (SparseMatrix<double>::InnerIterator entry(stiffness, column); entry; ++entry) {
      const int i = number[static_cast<std::size_t>(entry.row())];
      if (i < 0 && j < 0) inner.emplace_back(-1 - i, -1 - j, entry.value());
      if (i < 0 && j >= 0) across(-1 - i, j) = entry.value();
      if (i >= 0 && j >= 0) norton.stiffness(i, j) = entry.value();
    }
  }
  VectorXd other_load(others);
  for (int c = 0; c < components; ++c) {
    const int n = number[static_cast<std::size_t>(c)];
    (n < 0 ? other_load(-1 - n) : norton.force(n)) = load(c);
  }
  if (others == 0) return norton;
  SparseMatrix<double> k(others, others);
  k.setFromTriplets(inner.begin(), inner.end());
  const Eigen::SimplicialLLT<SparseMatrix<double>> factor(k);
  if (factor.info() != Eigen::Success)
    throw Error(ErrorCode::bad_input, "condense: the stiffness of the nodes without contact is not positive definite");
  norton.stiffness -= across.transpose() * factor.solve(across);
  norton.force -= across.transpose() * factor.solve(other_load);
  return norton;
}

std::array<double, 36> rigid_stiffness(const Norton& norton, const std::vector<Vec3d>& arms) {
  const auto contacts = static_cast<Eigen::Index>(arms.size());
  if (norton.stiffness.rows() != 3 * contacts)
    throw Error(ErrorCode::bad_input, fmt::format("condensed: {} arms for a stiffness of {} rows, allowed are 3 rows an arm",
                                                  contacts, norton.stiffness.rows()));
  MatrixXd moved = MatrixXd::Zero(3 * contacts, 6);  // a contact moves by d + w x arm
  for (Eigen::Index n = 0; n < contacts; ++n) {
    const auto [x, y, z] = arms[static_cast<std::size_t>(n)];
    moved.block<3, 3>(3 * n, 0).setIdentity();
    moved.block<3, 3>(3 * n, 3) << 0, z, -y, -z, 0, x, y, -x, 0;
  }
  std::array<double, 36> out{};
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(out.data()) = moved.transpose() * norton.stiffness * moved;
  return out;
}

void CondensedForce::linearise(const Linearised& linearised) noexcept {
  linearised_ = linearised;
  given_ = true;
}

void CondensedForce::receive(const FrameReport& report) noexcept { report_ = report; }

Wrench CondensedForce::tick(const Pose& tool, double /*dt*/) noexcept {
  Wrench out = report_.mean;
  if (!linear()) return out;
  const Vec3d d = vec::sub(tool.position, report_.tool.position), w = turn_between(report_.tool, tool);
  const std::array<double, 36>& k = linearised_.stiffness;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out.force[i] -= k[6 * i + j] * d[j] + k[6 * i + 3 + j] * w[j];
      out.torque[i] -= k[6 * (i + 3) + j] * d[j] + k[6 * (i + 3) + 3 + j] * w[j];
    }
  }
  if (!sticks_ && vec::dot(out.force, report_.mean.force) <= 0) return {};
  return out;
}

}  // namespace pliant::haptics
