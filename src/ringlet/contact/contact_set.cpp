#include "ringlet/contact/contact_set.h"

#include "ringlet/contact/settings.h"
#include "ringlet/math/collect.h"
#include "ringlet/math/parallel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace ringlet {
namespace {

// An orthonormal frame with its first axis along u and its second across u and v; 0 where they are parallel.
Mat3 frame(const Vec3 &u, const Vec3 &v) {
    Mat3 axes;
    axes.col(0) = u.normalized();
    axes.col(1) = u.cross(v).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
}

// The rotation by which a move from `start` to `end` turns a pair that it leaves rigid. It turns with the triangle or with both
// edges; where these are almost parallel, with an edge and the line to the other. The normal does not tell: it also turns as
// the closest points wander over a surface.
Mat3 pair_rotation(const Stencil &pair, View<Vec3> start, View<Vec3> end) {
    const int p = pair.vertex[0], q = pair.vertex[1], r = pair.vertex[2], s = pair.vertex[3];
    const auto turned = [&](const auto &frame_of) { return Mat3(frame_of(end) * frame_of(start).transpose()); };
    if (!pair.edge_edge()) return turned([&](View<Vec3> x) { return frame(x[r] - x[q], x[s] - x[q]); });
    const auto almost_parallel = [&](View<Vec3> x) {
        const Vec3 a = x[q] - x[p], b = x[s] - x[r];
        return a.cross(b).squaredNorm() <= contact_settings::parallel_sine2 * a.squaredNorm() * b.squaredNorm();
    };
    if (almost_parallel(start) || almost_parallel(end))
        return turned([&](View<Vec3> x) { return frame(x[q] - x[p], pair.separation(x)); });
    return turned([&](View<Vec3> x) { return frame(x[q] - x[p], x[s] - x[r]); });
}

// The contact of a pair at one of its points, but for what depends on the activation distance.
Contact contact_at(const CollisionMesh &mesh, const ContactMaterial &material, const ContactPair &pair,
                   const ContactPoint &point, View<Vec3> positions) {
    Contact contact{};
    contact.at = stencil(mesh, pair, point.closest);
    contact.name = contact_name(pair, point.number);
    contact.gap = std::sqrt(point.closest.distance2);
    const auto &vertex = contact.at.vertex;
    contact.barrier.normal = contact.friction.normal = contact.at.separation(positions) / contact.gap;
    contact.barrier.stiffness = point.share * pair_stiffness(mesh, contact.at, material);
    contact.friction.coefficient = material.friction_of(vertex[0], vertex[3]);
    contact.friction.stick_length = material.stick_length;
    return contact;
}

// The slip at which friction holds a force, given as InitialForce gives it.
Vec3 initial_slip(const Contact &contact, View<Vec3> positions, const Vec3 &force) {
    const Vec3 &normal = contact.friction.normal;
    const Vec3 edge = positions[contact.at.vertex[3]] - positions[contact.at.vertex[2]];
    const Vec3 tangent = (edge - normal.dot(edge) * normal).normalized();
    return contact.friction.slip_that_holds(force[1] * tangent + force[2] * normal.cross(tangent), force[0]);
}

// Calls work(point, gap, activation distance, barrier end, loaded fraction) for the points of a pair; beyond the activation
// distance a point does not push.
template <class Work>
void for_points_of(const CollisionMesh &mesh, const ContactPair &pair, const InitialOverlap *overlap, View<Vec3> positions,
                   const Work &work) {
    const double least_depth = contact_settings::least_loaded_depth * pair.d_hat;
    double d_hat = pair.d_hat, most = pair.d_hat; // the largest force that it takes up, per stiffness [m]
    if (overlap != nullptr) {
        d_hat = std::min(d_hat, overlap->activation), most = std::max(d_hat, least_depth);
        if (overlap->force > 0.0)
            most = std::min(most, -barrier(std::min(overlap->gap, pair.d_hat - least_depth), pair.d_hat, 0.0).first);
    }
    const double loaded_fraction = most / pair.d_hat;
    for_contact_points(mesh, pair, positions, [&](const ContactPoint &point) {
        const double gap = std::sqrt(point.closest.distance2);
        if (gap > 0.0) work(point, gap, d_hat, d_hat / contact_settings::d_hat_per_barrier_end, loaded_fraction);
    });
}

} // namespace

void ContactSet::begin(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &pairs,
                       View<InitialForce> initial, View<Vec3> positions) {
    std::map<std::array<int, 4>, Vec3> forces;
    for (const InitialForce &of : initial) forces[of.vertex] = of.force;
    overlaps.clear(), lagged_.clear(), resting_.clear(), friction_.clear();
    for (const ContactPair &pair : pairs) {
        const double gap = std::sqrt(pair.closest.distance2);
        const auto force = forces.find(stencil(mesh, pair, pair.closest).vertex);
        const bool loaded = force != forces.end() && gap > 0.0 && force->second[0] > 0.0;
        overlaps.add(contact_name(pair), gap, loaded ? force->second[0] : 0.0);
        if (!loaded) continue;
        for_contact_points(mesh, pair, positions, [&](const ContactPoint &point) {
            const Contact contact = contact_at(mesh, material, pair, point, positions);
            lagged_.push_back({contact.name, point.share * force->second[0]});
            friction_.push_back({contact.name, initial_slip(contact, positions, force->second)});
        });
    }
}

void ContactSet::commit_friction(View<Vec3> positions) {
    friction_.clear();
    for (const Contact &contact : contacts_)
        friction_.push_back({contact.name, contact.friction.kept_slip(contact.at.separation(positions))});
}

// Concatenates what add(pair, its initial overlap or null, list) appends for each pair.
template <class T, class Add>
std::vector<T> ContactSet::collect_of_pairs(const std::vector<ContactPair> &pairs, const Add &add) const {
    return collect_ranges<T>(int(pairs.size()), [&](int begin, int end, std::vector<T> &list) {
        InitialOverlaps::Search overlapping = overlaps.search();
        for (int k = begin; k < end; ++k) add(pairs[k], overlapping.find(pairs[k]), list);
    });
}

std::vector<Contact> ContactSet::linearise(const CollisionMesh &mesh, const ContactMaterial &material,
                                           const std::vector<ContactPair> &pairs, View<Vec3> start, View<Vec3> positions,
                                           double damping) const {
    const auto add = [&](const ContactPair &pair, const InitialOverlap *overlap, std::vector<Contact> &contacts) {
        for_points_of(mesh, pair, overlap, positions,
                      [&](const ContactPoint &point, double gap, double d_hat, double barrier_end, double loaded) {
                          Contact contact = contact_at(mesh, material, pair, point, positions);
                          if (mesh.moves[contact.at.vertex[0]] && mesh.moves[contact.at.vertex[3]])
                              contact.damping.coefficient = damping * contact.barrier.stiffness;
                          if (gap >= d_hat && contact.damping.coefficient == 0.0) return;
                          contact.barrier.d_hat = d_hat;
                          contact.barrier.end = barrier_end;
                          contact.loaded_fraction = loaded;
                          contact.friction.reference = contact.at.separation(start);
                          contacts.push_back(contact);
                      });
    };
    std::vector<Contact> found = collect_of_pairs<Contact>(pairs, add);
    parallel_for_known(friction_, found,
                       [](const FrictionState &before, Contact &now) { now.friction.reference -= before.slip; });
    if (guess_.empty()) return found;
    parallel_for(int(found.size()), [&](int k) {
        if (Friction &friction = found[k].friction; friction.coefficient > 0.0)
            friction.reference = pair_rotation(found[k].at, start, guess_) * friction.reference;
    });
    return found;
}

std::vector<PairEnergy> ContactSet::energies(const CollisionMesh &mesh, const ContactMaterial &material,
                                             const std::vector<ContactPair> &pairs, View<Vec3> positions) const {
    const auto add = [&](const ContactPair &pair, const InitialOverlap *overlap, std::vector<PairEnergy> &energies) {
        for_points_of(mesh, pair, overlap, positions,
                      [&](const ContactPoint &point, double gap, double d_hat, double barrier_end, double) {
                          if (gap >= d_hat) return;
                          const Stencil at = stencil(mesh, pair, point.closest);
                          energies.push_back({contact_name(pair, point.number),
                                              {mesh.object[at.vertex[0]], mesh.object[at.vertex[3]]},
                                              point.share * pair_stiffness(mesh, at, material),
                                              barrier(gap, d_hat, barrier_end).value});
                      });
    };
    std::vector<PairEnergy> found = collect_of_pairs<PairEnergy>(pairs, add);
    parallel_for_known(contacts_, found,
                       [](const Contact &contact, PairEnergy &there) { there.stiffness = contact.barrier.stiffness; });
    return found;
}

void ContactSet::find(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &pairs,
                      View<unsigned char> objects, View<Vec3> start, View<Vec3> positions, double damping) {
    overlaps.activate(mesh, material, pairs); // the same until contacts are found again, whatever the stiffness is then
    std::vector<Contact> found = linearise(mesh, material, pairs, start, positions, damping);
    if (resting_.empty()) {
        resting_.swap(lagged_);
    } else {
        const auto newest = resting_.insert(resting_.end(), lagged_.begin(), lagged_.end());
        std::inplace_merge(resting_.begin(), newest, resting_.end(),
                           [](const LaggedForce &a, const LaggedForce &b) { return a.name < b.name; });
    }
    parallel_for_known(resting_, found, [](const LaggedForce &before, Contact &now) {
        if (now.gap < now.barrier.d_hat) now.friction.normal_force = before.force;
    });
    resting_ = collect<LaggedForce>(int(resting_.size()), [&](int k, std::vector<LaggedForce> &left) {
        if (!any_marked(objects_of(mesh, resting_[k].name), objects)) left.push_back(resting_[k]);
    });
    contacts_ = std::move(found);
    lagged_.resize(contacts_.size());
    parallel_for(int(contacts_.size()), [&](int k) { lagged_[k] = {contacts_[k].name, contacts_[k].friction.normal_force}; });
    index(mesh);
}

void ContactSet::index(const CollisionMesh &mesh) {
    const int vertices = int(mesh.moves.size());
    roles_ = {size_t(vertices), count(), [&](int pair, const auto &add) {
                  const Stencil &at = stencil_of(pair);
                  for (int i = 0; i < 4; ++i)
                      if (mesh.moves[at.vertex[i]] && at.weight[i] != 0.0) add(at.vertex[i], Role{pair, i});
              }};
    vertices_ = collect<int>(vertices, [&](int v, std::vector<int> &touched) {
        if (!of(v).empty()) touched.push_back(v);
    });
}

} // namespace ringlet
