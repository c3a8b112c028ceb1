#include "haptics/submodel.h"

#include <algorithm>
#include <utility>

#include "model/elements/each_element.h"
#include "pliant/error.h"

namespace pliant::haptics {
namespace {

/// Whether the node moves in a way that a submodel cannot compute: on a curve, or rotated.
bool is_driven(const Constraint& c) { return c.turned != 0 || c.target != Vec3d{} || c.sine != Vec3d{}; }

/// Numbers of the nodes in the submodel by slot, -1 outside.
struct Numbering {
  std::vector<std::int32_t> number;
  std::vector<std::int32_t> slot;

  Numbering(const Model& model, const ElementGraph& graph, const std::vector<std::int32_t>& ring)
      : number(static_cast<std::size_t>(model.slots), -1) {
    for (std::int32_t e = 0; e < graph.elements(); ++e) {
      if (ring[static_cast<std::size_t>(e)] < 0) continue;
      for (const std::int32_t n : graph.nodes_of(e)) number[static_cast<std::size_t>(n)] = 0;
    }
    for (std::int32_t s = 0; s < model.slots; ++s) {
      if (number[static_cast<std::size_t>(s)] < 0) continue;
      number[static_cast<std::size_t>(s)] = static_cast<std::int32_t>(slot.size());
      slot.push_back(s);
    }
  }
  [[nodiscard]] std::int32_t of(std::int32_t s) const { return number[static_cast<std::size_t>(s)]; }
};

/// Marks the nodes that elements outside share.
std::vector<char> shared_nodes(const ElementGraph& graph, const std::vector<std::int32_t>& ring, const Numbering& numbers) {
  std::vector<char> shared(numbers.slot.size(), 0);
  for (std::int32_t e = 0; e < graph.elements(); ++e) {
    if (ring[static_cast<std::size_t>(e)] >= 0) continue;
    for (const std::int32_t n : graph.nodes_of(e)) {
      if (numbers.of(n) >= 0) shared[static_cast<std::size_t>(numbers.of(n))] = 1;
    }
  }
  for (std::size_t i = 0; i < shared.size(); ++i) {
    if (!graph.moves_alone(numbers.slot[i])) shared[i] = 1;
  }
  return shared;
}

/// These, and what moves on a curve.
std::vector<char> rim_of(const Model& model, const std::vector<char>& shared, const Numbering& numbers) {
  std::vector<char> rim = shared;
  for (const Constraint& c : model.constraints) {
    if (numbers.of(c.slot) >= 0 && is_driven(c)) rim[static_cast<std::size_t>(numbers.of(c.slot))] = 1;
  }
  return rim;
}

/// Copies the elements of a batch, of which `element` is the first in for_each_element().
void add_list(const ElementBatch& from, std::int32_t element, const std::vector<std::int32_t>& ring, const Numbering& numbers,
              Model& out) {
  ElementBatch batch;
  batch.kind = from.kind;
  batch.material = from.material;
  batch.body = from.body;
  batch.uniform = from.uniform;
  if (from.uniform) batch.records = from.records;
  for (std::size_t e = 0; e < from.size(); ++e) {
    if (ring[static_cast<std::size_t>(element) + e] < 0) continue;
    for (const std::int32_t n : from.nodes_of(e)) batch.nodes.push_back(numbers.of(n));
    const std::span<const double> record = from.record_of(e);
    if (!from.uniform) batch.records.insert(batch.records.end(), record.begin(), record.end());
    batch.share.push_back(from.share[e]);
    batch.id.push_back(from.id[e]);
  }
  if (batch.size() > 0) out.batches.push_back(std::move(batch));
}

/// The same for bricks. Returns the number of their elements.
std::int32_t add_bricks(const Model& model, const BrickBatch& from, std::int32_t element, const std::vector<std::int32_t>& ring,
                        const Numbering& numbers, Model& out) {
  ElementBatch batch;
  batch.kind = BrickBatch::kind();
  batch.material = from.material;
  batch.body = from.body;
  batch.uniform = true;
  batch.records = from.record();
  std::int32_t count = 0;
  const std::int32_t first = from.first * PLIANT_BRICK_NODES, end = first + from.count * PLIANT_BRICK_NODES;
  for (std::int32_t slot = first; slot < end; ++slot) {
    const double fill = model.brick_fill[static_cast<std::size_t>(slot)];
    if (!(fill > 0)) continue;
    const std::int32_t own = element + count++;
    if (ring[static_cast<std::size_t>(own)] < 0) continue;
    for (const std::int32_t n : brick_cell_corners(model, slot)) batch.nodes.push_back(numbers.of(n));
    batch.share.push_back(fill);
    batch.id.push_back(model.brick_cell[static_cast<std::size_t>(slot)]);
  }
  if (batch.size() > 0) out.batches.push_back(std::move(batch));
  return count;
}

void add_nodes(const Model& model, const Numbering& numbers, const std::vector<char>& rim, Model& out) {
  const std::size_t count = numbers.slot.size(), slots = (count + PLIANT_TILE - 1) / PLIANT_TILE * PLIANT_TILE;
  out.list_base = 0;
  out.list_end = out.slots = static_cast<std::int32_t>(slots);
  out.rest.resize(slots);
  out.mass.resize(slots);
  out.damping.resize(slots);
  out.velocity.resize(slots);
  if (!model.added.empty()) out.added.resize(slots);
  for (std::size_t i = 0; i < count; ++i) {
    const auto s = static_cast<std::size_t>(numbers.slot[i]);
    out.rest[i] = model.rest[s];
    out.mass[i] = model.mass[s];
    out.damping[i] = model.damping[s];
    if (!model.added.empty()) out.added[i] = model.added[s];
  }
  out.curves = model.curves;
  if (out.curves.empty()) out.curves.emplace_back();
  for (const NodeForce& f : model.forces) {  // among them what takes the weight of added inertia away
    const std::int32_t n = f.reserved ? -1 : numbers.of(f.slot);
    if (n >= 0 && rim[static_cast<std::size_t>(n)] == 0) out.forces.push_back({n, f.force, f.curve, false});
  }
  std::vector<const Constraint*> held(count, nullptr);
  for (const Constraint& c : model.constraints) {
    if (numbers.of(c.slot) >= 0) held[static_cast<std::size_t>(numbers.of(c.slot))] = &c;
  }
  for (std::size_t i = 0; i < count; ++i) {
    Constraint c;
    c.slot = static_cast<std::int32_t>(i);
    c.axes = rim[i] != 0 ? 7 : held[i] != nullptr ? held[i]->axes : 0;
    if (c.axes != 0) out.constraints.push_back(c);
  }
}

/// Copies the points whose nodes are all inside. Those at the rim would be pushed by the few of their nodes that are free.
std::vector<std::int32_t> add_points(const Model& model, const Numbering& numbers, const std::vector<char>& rim, Model& out) {
  std::vector<std::int32_t> chosen;
  out.tools = model.tools;
  if (model.contact == nullptr) return chosen;
  auto points = std::make_shared<ContactPoints>();
  const ContactPoints& from = *model.contact;
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::array<std::int32_t, 8> nodes = from.nodes[i];
    for (std::int32_t& n : nodes) n = numbers.of(n);
    if (std::any_of(nodes.begin(), nodes.end(), [&](std::int32_t n) { return n < 0 || rim[static_cast<std::size_t>(n)] != 0; }))
      continue;
    chosen.push_back(static_cast<std::int32_t>(i));
    points->rest.push_back(from.rest[i]);
    points->nodes.push_back(nodes);
    points->weights.push_back(from.weights[i]);
    points->area.push_back(from.area[i]);
    points->body.push_back(from.body[i]);
    points->normal.push_back(from.normal[i]);
    points->apart.push_back(from.apart[i]);
    if (!from.sides.empty()) points->sides.push_back(from.sides[i]);
    if (!from.joined.empty()) points->joined.push_back(from.joined[i]);
  }
  points->spacing = from.spacing;
  out.contact = std::move(points);
  out.contact_laws = model.contact_laws;
  return chosen;
}

std::vector<std::pair<std::int64_t, std::int32_t>> names_of(const Model& model, const Numbering& numbers) {
  std::vector<std::pair<std::int64_t, std::int32_t>> names;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::vector<std::int32_t>& slot = model.bodies[b].slot;
    for (std::size_t n = 0; n < slot.size(); ++n) {
      const std::int32_t own = slot[n] < 0 ? -1 : numbers.of(slot[n]);
      if (own >= 0) names.emplace_back(static_cast<std::int64_t>(b) << 32 | static_cast<std::int64_t>(n), own);
    }
  }
  return names;
}

}  // namespace

ElementGraph::ElementGraph(const Model& model) : coupled_(static_cast<std::size_t>(model.slots), 0) {
  for_each_element(model, [&](const ElementView& e) {
    nodes_.insert(nodes_.end(), e.slots.begin(), e.slots.end());
    first_.push_back(static_cast<std::int32_t>(nodes_.size()));
  });
  for (const FlsmBatch& batch : model.flsm) {
    for (const std::int32_t s : batch.slot) coupled_[static_cast<std::size_t>(s)] = 1;
  }
  offset_.assign(static_cast<std::size_t>(model.slots) + 1, 0);
  for (const std::int32_t n : nodes_) ++offset_[static_cast<std::size_t>(n) + 1];
  for (std::size_t s = 1; s < offset_.size(); ++s) offset_[s] += offset_[s - 1];
  at_.resize(nodes_.size());
  std::vector<std::int32_t> next(offset_.begin(), offset_.end() - 1);
  for (std::int32_t e = 0; e < elements(); ++e) {
    for (std::int32_t k = first_[static_cast<std::size_t>(e)]; k < first_[static_cast<std::size_t>(e) + 1]; ++k)
      at_[static_cast<std::size_t>(next[static_cast<std::size_t>(nodes_[static_cast<std::size_t>(k)])]++)] = e;
  }
}

std::vector<std::int32_t> ElementGraph::rings(const std::vector<std::int32_t>& seeds, std::int32_t rings) const {
  std::vector<std::int32_t> ring(static_cast<std::size_t>(elements()), -1), nodes = seeds;
  std::vector<char> seen(coupled_.size(), 0);
  for (const std::int32_t s : seeds) seen[static_cast<std::size_t>(s)] = 1;
  for (std::int32_t r = 0; r <= rings && !nodes.empty(); ++r) {
    std::vector<std::int32_t> next;
    for (const std::int32_t s : nodes) {
      for (std::int32_t k = offset_[static_cast<std::size_t>(s)]; k < offset_[static_cast<std::size_t>(s) + 1]; ++k) {
        const auto e = static_cast<std::size_t>(at_[static_cast<std::size_t>(k)]);
        if (ring[e] >= 0) continue;
        ring[e] = r;
        for (std::int32_t c = first_[e]; c < first_[e + 1]; ++c) {
          const std::int32_t n = nodes_[static_cast<std::size_t>(c)];
          if (std::exchange(seen[static_cast<std::size_t>(n)], 1) == 0) next.push_back(n);
        }
      }
    }
    nodes = std::move(next);
  }
  return ring;
}

Submodel extract(const Model& model, const ElementGraph& graph, const std::vector<std::int32_t>& ring) {
  const Numbering numbers(model, graph, ring);
  if (numbers.slot.empty()) throw Error(ErrorCode::internal, "haptics: a buffer without elements");
  Submodel sub;
  sub.slot = numbers.slot;
  const std::vector<char> shared = shared_nodes(graph, ring, numbers);
  sub.rim = rim_of(model, shared, numbers);
  sub.whole = std::find(shared.begin(), shared.end(), 1) == shared.end();
  sub.names = names_of(model, numbers);
  sub.elements = std::count_if(ring.begin(), ring.end(), [](std::int32_t r) { return r >= 0; });
  auto out = std::make_shared<Model>();
  for (const ModelBody& body : model.bodies) {
    out->bodies.emplace_back();
    out->bodies.back().name = body.name;
    out->bodies.back().element = body.element;
    out->bodies.back().spacing = body.spacing;
  }
  out->recovers = model.recovers;
  out->element_bound = model.element_bound;
  out->shortest = model.shortest;
  add_nodes(model, numbers, sub.rim, *out);
  std::int32_t element = 0;
  for (const ElementBatch& batch : model.batches) {
    add_list(batch, element, ring, numbers, *out);
    element += static_cast<std::int32_t>(batch.size());
  }
  for (const BrickBatch& batch : model.brick_batches) element += add_bricks(model, batch, element, ring, numbers, *out);
  sub.point = add_points(model, numbers, sub.rim, *out);
  sub.model = std::move(out);
  return sub;
}

}  // namespace pliant::haptics
