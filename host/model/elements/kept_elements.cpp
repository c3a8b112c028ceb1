#include "model/elements/kept_elements.h"

#include <algorithm>

namespace pliant {

KeptElements::KeptElements(const Model* earlier, const ElementBatch& now) : earlier_(earlier) {
  if (earlier == nullptr || now.uniform) return;
  const auto same = [&](const ElementBatch& b) {
    return b.kind == now.kind && b.body == now.body && b.material == now.material;
  };
  const auto found = std::find_if(earlier->batches.begin(), earlier->batches.end(), same);
  if (found == earlier->batches.end() || found->frequency.size() != found->size()) return;
  batch_ = &*found;
  place_.assign(static_cast<std::size_t>(1 + *std::max_element(found->id.begin(), found->id.end())), -1);
  for (std::size_t i = 0; i < found->size(); ++i) place_[static_cast<std::size_t>(found->id[i])] = static_cast<std::int32_t>(i);
}

std::optional<KeptElements::Numbers> KeptElements::find(std::size_t e, std::span<const Vec3d> x) const {
  if (e >= place_.size() || place_[e] < 0) return {};
  const auto at = static_cast<std::size_t>(place_[e]);
  const std::span<const std::int32_t> slots = batch_->nodes_of(at);
  for (std::size_t a = 0; a < slots.size(); ++a) {
    if (earlier_->rest[static_cast<std::size_t>(slots[a])] != x[a]) return {};
  }
  return Numbers{batch_->record_of(at), batch_->frequency[at]};
}

}  // namespace pliant
