#include "simulation/edits/cut_strokes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/vec.h"
#include "simulation/edits/front_point.h"

namespace pliant {
namespace {

constexpr double kShallow = 0.55;   ///< a sample deeper in the undeformed body than this, a little more than samples are apart,
                                    ///< is not at its surface [edges]
constexpr std::size_t kNextTo = 2;  ///< samples this near in their row meet the surface at one place
constexpr double kAtRest = 0.25;  ///< a point of contact that has moved by less, as samples come and go, has not moved [edges]
constexpr double kFarthest = 2;   ///< one that is farther from the last place belongs to another stroke [edges]
constexpr double kDetour = 2;     ///< so does one whose way over the surface is that many times as long as the straight line

bool is_of(const FrontSample& s, FrontKind kind) { return s.kind == static_cast<std::int32_t>(kind); }

/// Samples that the edge had let go and that have met tissue again in the same update are in contact all the time.
bool touches(const FrontSample& s, bool held) {
  return is_of(s, FrontKind::held) || is_of(s, FrontKind::beside) || (is_of(s, FrontKind::ahead) && held);
}

}  // namespace

void CutStrokes::start(const Model& uncut) {
  surfaces_.clear();
  if (!cuts_by_force(run_.scene)) return;
  const ModelSurface& all = uncut.surface;
  for (const ModelBody& body : uncut.bodies) {
    OwnSurface own;
    own.first_vertex = body.first_vertex;
    const auto vertex = all.rest.begin() + body.first_vertex;
    TriangleMesh mesh;
    mesh.vertices.assign(vertex, vertex + body.vertices);
    const auto triangle = all.triangles.begin() + body.first_triangle;
    mesh.triangles.assign(triangle, triangle + body.triangles);
    for (auto& t : mesh.triangles) {
      for (std::int32_t& v : t) v -= body.first_vertex;
    }
    if (!mesh.triangles.empty()) own.walk = std::make_unique<SurfaceWalk>(std::move(mesh));
    surfaces_.push_back(std::move(own));
  }
}

/// The weight of a sample falls to zero with its depth, so that the point of contact moves smoothly as samples come and go: of
/// an edge that enters the body the place where it does, of one that lies on it the middle.
std::vector<CutStrokes::Meeting> CutStrokes::meetings(const std::vector<FrontSample>& samples, const std::vector<char>& held,
                                                      EditedBodies& bodies, const std::vector<std::vector<Vec3d>>& x) const {
  std::vector<Meeting> all;
  const double shallow = kShallow * run_.settings.blade_edge;
  std::size_t last = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const FrontSample& s = samples[i];
    const bool in_contact = touches(s, i < held.size() && held[i] != 0) && surface(s.body).walk != nullptr;
    const double weight = in_contact ? 1 - surface(s.body).walk->closest(s.point.rest, shallow).distance / shallow : 0;
    if (!(weight > 0)) continue;
    const auto b = static_cast<std::size_t>(s.body);
    if (all.empty() || i > last + kNextTo || all.back().body != s.body) all.emplace_back().body = s.body;
    last = i;
    Meeting& m = all.back();
    m.weight += weight;
    m.rest = vec::add(m.rest, vec::mul(s.point.rest, weight));
    m.place = vec::add(m.place, vec::mul(front_place(bodies.topology(b), x[b], s.point), weight));
    m.gave_way = m.gave_way || s.depth > 0 || is_of(s, FrontKind::beside);
  }
  for (Meeting& m : all) {
    m.rest = vec::mul(m.rest, 1 / m.weight);
    m.place = vec::mul(m.place, 1 / m.weight);
    const ClosestPoint foot = surface(m.body).walk->closest(m.rest);
    m.foot = {foot.triangle, foot.point};
  }
  return all;
}

/// Walks over the surface to a meeting and adds the attempts on the way to `made`. Returns false if the way is no way of one
/// stroke.
bool CutStrokes::go_on(StrokeContact& contact, const Meeting& to, std::vector<StrokeAttempt>& made) const {
  const double straight = vec::norm(vec::sub(to.foot.at, contact.rest)), edge = run_.settings.blade_edge;
  const double before = contact.time, now = run_.state.clock.time();
  if (straight < kAtRest * edge) {
    contact.place = to.place;
    contact.time = now;
    return true;
  }
  if (straight > kFarthest * edge) return false;
  const OwnSurface& own = surface(to.body);
  const auto way = own.walk->way({contact.triangle, contact.rest}, to.foot, kDetour * straight);
  if (!way) return false;
  for (const VertexOnWay& v : own.walk->vertices(*way, contact.vertex - own.first_vertex)) {
    const Vec3d place = vec::add(contact.place, vec::mul(vec::sub(to.place, contact.place), v.share));
    made.push_back({contact.stroke, to.body, contact.vertex, v.vertex + own.first_vertex, before + v.share * (now - before),
                    place, v.at, to.gave_way});
    contact.vertex = made.back().to;
  }
  contact.triangle = to.foot.triangle;
  contact.rest = to.foot.at;
  contact.place = to.place;
  contact.time = now;
  return true;
}

void CutStrokes::look(const std::string& blade, const std::vector<FrontSample>& samples, const std::vector<char>& held,
                      EditedBodies& bodies, const std::vector<std::vector<Vec3d>>& x) {
  const std::vector<Meeting> now = meetings(samples, held, bodies, x);
  const auto known = report_.strokes.find(blade);
  if (now.empty() && (known == report_.strokes.end() || known->second.contacts.empty())) return;
  BladeStrokes& own = report_.strokes[blade];
  std::erase_if(own.contacts, [&](const StrokeContact& c) {  // of a damaged checkpoint
    const SurfaceWalk* walk = surface(c.body).walk.get();
    return walk == nullptr || c.triangle < 0 || static_cast<std::size_t>(c.triangle) >= walk->mesh().triangles.size();
  });
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // distance, contact, meeting
  for (std::size_t c = 0; c < own.contacts.size(); ++c) {
    for (std::size_t m = 0; m < now.size(); ++m) {
      if (own.contacts[c].body == now[m].body)
        pairs.emplace_back(vec::norm(vec::sub(now[m].foot.at, own.contacts[c].rest)), c, m);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<StrokeContact> next;
  std::vector<StrokeAttempt> made;
  std::vector<char> went_on(own.contacts.size()), met(now.size());
  for (const auto& [distance, c, m] : pairs) {
    if (went_on[c] != 0 || met[m] != 0 || !go_on(own.contacts[c], now[m], made)) continue;
    went_on[c] = met[m] = 1;
    next.push_back(own.contacts[c]);
  }
  for (std::size_t m = 0; m < now.size(); ++m) {
    if (met[m] != 0) continue;
    const OwnSurface& met_surface = surface(now[m].body);
    const std::int32_t vertex = met_surface.first_vertex + met_surface.walk->vertex_at(now[m].foot);
    next.push_back(
        {own.strokes++, now[m].body, now[m].foot.triangle, vertex, now[m].foot.at, now[m].place, run_.state.clock.time()});
  }
  own.contacts = std::move(next);
  std::stable_sort(made.begin(), made.end(), [](const StrokeAttempt& a, const StrokeAttempt& b) { return a.time < b.time; });
  own.attempts += static_cast<std::int64_t>(made.size());
  own.last.insert(own.last.end(), made.begin(), made.end());
  if (own.last.size() > BladeStrokes::kMost)
    own.last.erase(own.last.begin(), own.last.end() - static_cast<std::ptrdiff_t>(BladeStrokes::kMost));
}

}  // namespace pliant
