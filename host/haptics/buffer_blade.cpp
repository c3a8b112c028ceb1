#include "haptics/buffer_blade.h"

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "haptics/driven_part.h"
#include "simulation/edits/blade_fronts.h"

namespace pliant::haptics {
namespace {

constexpr double kAgree = 0.1;  ///< time in which the fronts come to those of the simulation [s]

template <class T>
void copy(const std::vector<T>& from, std::span<T> to) noexcept {
  std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
}

}  // namespace

BufferBlade::BufferBlade(TwinRunner& runner, double length)
    : u_(runner.reals("node_u")),
      weight_(runner.reals("blade_weight")),
      share_(runner.reals("blade_share")),
      data_(runner.reals("blade_data")),
      front_(runner.reals("blade_front")),
      force_(runner.reals("blade_force")),
      pose_(runner.reals("blade_pose")),
      node_(runner.ints("blade_node")),
      slot_(runner.ints("blade_slot")),
      free_(runner.ints("blade_free")),
      first_(runner.ints("blade_first")),
      entry_(runner.ints("blade_entry")),
      length_(length),
      samples_(data_.size() / blade_sample_numbers),
      limit_(samples_),
      depth_(samples_),
      draw_(samples_) {}

BufferBlade::Front BufferBlade::front_of(std::size_t i) const noexcept {
  const float* data = data_.data() + blade_sample_numbers * i;
  Front front;
  front.any = data[6] >= 0;
  if (!front.any) return front;
  front.point = {data[0], data[1], data[2]};
  front.normal = {data[3], data[4], data[5]};
  for (std::size_t at = blade_sample_nodes * i; at < blade_sample_nodes * (i + 1); ++at) {
    const float* u = u_.data() + 4 * static_cast<std::size_t>(node_[at]);
    for (std::size_t c = 0; c < 3; ++c) front.point[c] += static_cast<double>(weight_[at]) * u[c];
  }
  front.advance = front_[2 * i];
  return front;
}

/// The front that was there before, measured from the new front point. Returns false if there was none, or one so far away that
/// it belonged to another place.
bool BufferBlade::keep(std::size_t i, const Front& before) noexcept {
  const Front now = front_of(i);
  if (!before.any || !now.any) return false;
  const Vec3d place = vec::add(before.point, vec::mul(before.normal, before.advance));
  const double own = vec::dot(vec::sub(place, now.point), now.normal);
  if (!(std::abs(now.advance - own) < edge_)) return false;
  front_[2 * i] = static_cast<float>(own);
  return true;
}

/// Where the simulation's front would be if its edge, at `state.pose`, were that of the hand [m beyond the front point].
double BufferBlade::front_at_hand(std::size_t i, const BladeState& state) const noexcept {
  const float* data = data_.data() + blade_sample_numbers * i;
  const BladeSegment edge = blade_edge(state.pose, length_);
  double front = state.front[2 * i];
  for (std::size_t c = 0; c < 3; ++c) {
    const double there = edge[0][c] + data[8] * (edge[1][c] - edge[0][c]), here = at_[c] + data[8] * span_[c];
    front -= (there - here) * data[3 + c];
  }
  return front;
}

void BufferBlade::copy_lists(const BladeState& s) noexcept {
  copy(s.node, node_);
  copy(s.weight, weight_);
  copy(s.share, share_);
  copy(s.slot, slot_);
  copy(s.free, free_);
  copy(s.first, first_);
  copy(s.entry, entry_);
  copy(s.depth, std::span<float>(depth_));
  for (std::size_t i = 0; i < samples_; ++i) limit_[i] = s.data[blade_sample_numbers * i + 6];
  edge_ = s.edge;
}

void BufferBlade::start(const BladeState& s) noexcept {
  if (samples_ == 0) return;
  copy_lists(s);
  copy(s.data, data_);
  copy(s.front, front_);
  drawn_for_ = 0;
  fresh_ = true;
}

void BufferBlade::follow(const BladeState& s, double seconds) noexcept {
  if (samples_ == 0 || s.front.size() != front_.size()) return;
  for (std::size_t i = 0; i < samples_; ++i) {
    const Front before = front_of(i);
    const auto copy_part = [i](const auto& from, auto to, std::size_t size) {
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(size * i), size,
                  to.begin() + static_cast<std::ptrdiff_t>(size * i));
    };
    copy_part(s.node, node_, blade_sample_nodes);
    copy_part(s.weight, weight_, blade_sample_nodes);
    copy_part(s.data, data_, blade_sample_numbers);
    copy_part(s.front, front_, 2);
    draw_[i] = 0;
    if (!(data_[blade_sample_numbers * i + 6] >= 0)) continue;
    const double wanted = front_at_hand(i, s);
    if (fresh_ || !keep(i, before)) front_[2 * i] = static_cast<float>(wanted);
    draw_[i] = static_cast<float>((wanted - front_[2 * i]) / kAgree);
  }
  fresh_ = false;
  drawn_for_ = seconds;
  copy_lists(s);
}

void BufferBlade::carry(const BufferBlade& before) noexcept {
  if (before.samples_ != samples_) return;
  at_ = before.at_;
  span_ = before.span_;
  for (std::size_t i = 0; i < samples_; ++i) keep(i, before.front_of(i));
  fresh_ = before.fresh_;
}

void BufferBlade::hold(const Pose& hand) noexcept {
  const BladeSegment edge = blade_edge(hand, length_);
  at_ = edge[0];
  span_ = vec::sub(edge[1], edge[0]);
}

/// Tissue that has given way since the simulation's state resists less (BladeFronts::weaken).
void BufferBlade::advance(double h) noexcept {
  const double drawn = std::min(h, drawn_for_);
  drawn_for_ -= drawn;
  for (std::size_t i = 0; i < samples_; ++i) {
    front_[2 * i] += static_cast<float>(draw_[i] * drawn);
    const double advance = front_[2 * i];
    if (!(limit_[i] > 0) || !(advance > 0)) continue;
    const double left = integrity_left(depth_[i] + advance, edge_) / integrity_left(depth_[i], edge_);
    data_[blade_sample_numbers * i + 6] = static_cast<float>(limit_[i] * left);
  }
}

void BufferBlade::move(const Pose& from, const Pose& to, double h) noexcept {
  if (samples_ == 0) return;
  advance(h);
  float* out = pose_.data();
  for (const Pose& at : {from, to}) {
    hold(at);
    for (const double x : at_) *out++ = static_cast<float>(x);
    for (const double x : span_) *out++ = static_cast<float>(x);
  }
}

Wrench BufferBlade::read() noexcept {
  Wrench sum;
  pressing_ = 0;
  for (std::size_t i = 0; i < samples_; ++i) {
    const float* f = force_.data() + blade_force_numbers * i;
    if (!(f[3] > 0)) continue;
    ++pressing_;
    const Vec3d on_blade{-f[0], -f[1], -f[2]};
    const double place = data_[blade_sample_numbers * i + 8];
    sum.force = vec::add(sum.force, on_blade);
    sum.torque = vec::add(sum.torque, vec::cross(vec::mul(span_, place - 0.5), on_blade));
  }
  return sum;
}

}  // namespace pliant::haptics
