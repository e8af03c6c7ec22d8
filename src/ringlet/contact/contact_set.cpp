#include "ringlet/contact/contact_set.h"

#include "ringlet/math/collect.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ringlet {
namespace {

constexpr double least_room = 0.01; // of its distance, in which a pair that began near comes to bear

// Ascending as pairs are, and as the contacts of one pair are.
constexpr int places_of_pair = 7; // at most
uint64_t name(const ContactPair &touch, int which = 0) {
    return uint64_t(!touch.edge_edge) << 63 | uint64_t(touch.primitive[0]) << 33 | uint64_t(touch.primitive[1]) << 3 |
           uint64_t(which);
}

// Where a pair pushes, and with what share of its stiffness.
struct Place {
    ClosestPoints nearest;
    double share;
    int which;
};

// The nearest points of two edges that are almost parallel jump from end to end as they turn. What pushes there is shared out
// among the ends of both, each with what is nearest on the other edge, and nothing jumps. On a surface, points do this. Calls
// work with each place, in order.
template <class Work> void for_places(const CollisionMesh &mesh, const ContactPair &touch, View<Vec3> now, const Work &work) {
    constexpr double almost = 0.01; // sin² of the angle
    if (!touch.edge_edge || std::max(touch.primitive[0], touch.primitive[1]) >= mesh.strand_edges)
        return work(Place{touch.closest, 1.0, 0});
    const auto [a0, a1] = mesh.edges[touch.primitive[0]];
    const auto [b0, b1] = mesh.edges[touch.primitive[1]];
    const Vec3 a = now[a1] - now[a0], b = now[b1] - now[b0];
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), sine2 = a.cross(b).squaredNorm();
    const double s = std::min(sine2 / (almost * aa * bb + 1e-300), 1.0), crossing = s * s * (3.0 - 2.0 * s);
    if (crossing > 0.0) work(Place{touch.closest, crossing, 0});
    if (crossing == 1.0) return;
    const double share = 0.5 * (1.0 - crossing); // two of the four ends are beside the other edge, as a rule
    const auto at = [&](double u, double v, int which) {
        work(Place{{{1.0 - u, u, v - 1.0, -v}, (now[a0] + u * a - now[b0] - v * b).squaredNorm()}, share, which});
    };
    for (const double end : {0.0, 1.0}) at(end, closest::fraction((now[a0] + end * a - now[b0]).dot(b), bb), 1 + int(end));
    for (const double end : {0.0, 1.0}) at(closest::fraction((now[b0] + end * b - now[a0]).dot(a), aa), end, 3 + int(end));
}

// Which vertices a pair has, and with what weights they say where it touches.
struct Sides {
    std::array<int, 4> vertex;
    std::array<double, 4> weight;
    int first; // of these are the first's
};

Sides sides(const CollisionMesh &mesh, const ContactPair &touch, const ClosestPoints &nearest) {
    Sides sides{{}, nearest.weights, touch.edge_edge ? 2 : 1};
    with_vertices(mesh, touch, [&](const auto &a, const auto &b) {
        std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), sides.vertex.begin()));
    });
    return sides;
}

// Of its softer side. What is held, beside what moves, is as soft as that: where one end of an edge is held, and touches, the
// other is not to be pushed without bound.
double stiffness(const Sides &sides, const ContactMaterial &material) {
    const auto of_side = [&](int begin, int end) {
        double softest = std::numeric_limits<double>::infinity(), softness = 0.0;
        for (int i = begin; i < end; ++i) softest = std::min(softest, material.stiffness[sides.vertex[i]]);
        for (int i = begin; i < end; ++i) {
            const double own = material.stiffness[sides.vertex[i]];
            softness += std::abs(sides.weight[i]) / (std::isfinite(own) ? own : softest);
        }
        return 1.0 / softness;
    };
    return std::min(of_side(0, sides.first), of_side(sides.first, 4));
}

// Work for those of `now` whose pairs `before` has, both in order.
template <class Known, class Found, class Work>
void for_known(const std::vector<Known> &before, std::vector<Found> &now, const Work &work) {
    auto known = before.begin();
    for (Found &found : now) {
        while (known != before.end() && known->pair < found.pair) ++known;
        if (known == before.end()) return;
        if (known->pair == found.pair) work(*known, found);
    }
}

// Without what depends on from where on it pushes.
Contact contact(const CollisionMesh &mesh, const ContactMaterial &material, const ContactPair &touch, const Place &place,
                View<Vec3> now) {
    const Sides of = sides(mesh, touch, place.nearest);
    Contact contact{};
    contact.vertex = of.vertex, contact.weight = of.weight, contact.first = of.first;
    contact.normal = separation(contact, now) / std::sqrt(place.nearest.distance2);
    contact.stiffness = place.share * stiffness(of, material);
    contact.friction =
        material.friction[material.material[of.vertex[0]] * material.materials + material.material[of.vertex[3]]];
    contact.give = material.give;
    contact.pair = name(touch, place.which);
    return contact;
}

// How far a contact is sheared that bears and holds with such a force, which is told as Bearing tells it.
Vec3 shear_to_hold(const Contact &contact, View<Vec3> now, const Vec3 &force) {
    const Vec3 way = now[contact.vertex[3]] - now[contact.vertex[2]];
    const Vec3 aside = (way - contact.normal.dot(way) * contact.normal).normalized();
    const Vec3 holds = force[1] * aside + force[2] * contact.normal.cross(aside);
    const double most = contact.friction * force[0], length = holds.norm();
    if (!(most > 0.0 && length > 0.0)) return Vec3::Zero();
    return -sheared_to_hold(std::min(length / most, 1.0)) * contact.give / length * holds;
}

// A pair goes on from what it held as the step began, which turns with it.
void go_on(const Hold &held, Contact &contact) {
    const Mat3 turn = Eigen::Quaterniond::FromTwoVectors(held.normal, contact.normal).toRotationMatrix();
    contact.start = turn * (contact.start - held.shear);
}

} // namespace

void ContactSet::begin(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &touching,
                       View<Bearing> bearing, View<Vec3> now) {
    std::map<std::array<int, 4>, Vec3> forces;
    for (const Bearing &bears : bearing) forces[bears.vertex] = bears.force;
    early_.clear(), expected_.clear(), held_.clear();
    for (const ContactPair &touch : touching) {
        const Sides of = sides(mesh, touch, touch.closest);
        const double apart = std::sqrt(touch.closest.distance2);
        Beginning &early = early_[name(touch)] = {apart, 0.0, apart};
        const auto force = forces.find(of.vertex);
        if (force == forces.end() || !(apart > 0.0 && force->second[0] > 0.0)) continue;
        early.bears = force->second[0];
        for_places(mesh, touch, now, [&](const Place &place) {
            const Contact bears = contact(mesh, material, touch, place, now);
            expected_.push_back({bears.pair, place.share * early.bears});
            held_.push_back({bears.pair, shear_to_hold(bears, now, force->second), bears.normal});
        });
    }
}

void ContactSet::part_early(double way) {
    for (auto &[pair, early] : early_) early.push = early.apart += way;
}

void ContactSet::stay_early(const std::vector<ContactPair> &touching, View<Vec3> now, double way) {
    constexpr double nearest = 0.01;
    for (auto &[pair, early] : early_) early.bears = 0.0;
    for (const Contact &contact : contacts_) {
        const auto early = early_.find(contact.pair & ~uint64_t(places_of_pair));
        if (early != early_.end()) early->second.bears += contact_force(contact, separation(contact, now));
    }
    Early stay;
    for (const ContactPair &touch : touching) {
        const auto found = early_.find(name(touch));
        if (found == early_.end()) continue;
        Beginning &early = stay[found->first] = found->second;
        const double least = nearest * touch.d_hat;
        if (early.apart < least) early.apart = std::min(early.apart + way, least);
    }
    early_ = std::move(stay);
}

void ContactSet::hold(View<Vec3> now) {
    held_.clear();
    for (const Contact &contact : contacts_) {
        const Vec3 sheared = shear(contact, separation(contact, now));
        const double length = sheared.norm();
        held_.push_back(
            {contact.pair, length > contact.give ? Vec3(contact.give / length * sheared) : sheared, contact.normal});
    }
}

// Calls work(where it pushes, at what distance, from which distance on [m], where its barrier ends [m], what part of its
// distance it has to come to bear).
template <class Work>
void ContactSet::for_pushing(const CollisionMesh &mesh, const ContactPair &touch, View<Vec3> now, const Work &work) const {
    const auto early = early_.find(name(touch));
    double distance = touch.d_hat, room = 1.0;
    if (early != early_.end() && early->second.apart < touch.d_hat) {
        distance = std::min(distance, early->second.push);
        if (early->second.bears > 0.0) room = std::max(1.0 - early->second.apart / touch.d_hat, least_room);
    }
    const bool by_planes = with_vertices(mesh, touch, [&](const auto &a, const auto &b) {
        return goes_by_planes(mesh.object[a[0]]) || goes_by_planes(mesh.object[b[0]]);
    });
    for_places(mesh, touch, now, [&](const Place &place) {
        const double apart = std::sqrt(place.nearest.distance2);
        if (!(apart > 0.0 && apart < distance)) return;
        double barrier_end = distance / 100;
        if (by_planes) barrier_end = std::min(std::clamp(0.25 * apart, barrier_end, touch.d_hat / 64), distance / 64);
        work(place, apart, distance, barrier_end, room);
    });
}

std::vector<Contact> ContactSet::of_touching(const CollisionMesh &mesh, const ContactMaterial &material,
                                             const std::vector<ContactPair> &touching, View<Vec3> start, View<Vec3> now) const {
    std::vector<Contact> found = collect<Contact>(int(touching.size()), [&](int k, std::vector<Contact> &contacts) {
        const ContactPair &touch = touching[k];
        for_pushing(mesh, touch, now, [&](const Place &place, double apart, double distance, double barrier_end, double room) {
            Contact contact = ringlet::contact(mesh, material, touch, place, now);
            contact.distance = distance;
            contact.barrier_end = barrier_end;
            contact.room = room;
            contact.start = separation(contact, start);
            contact.gap = apart;
            contact.force = contact_force(contact, separation(contact, now));
            contacts.push_back(contact);
        });
    });
    for_known(held_, found, go_on);
    return found;
}

std::vector<ContactSet::Push> ContactSet::pushing(const CollisionMesh &mesh, const ContactMaterial &material,
                                                  const std::vector<ContactPair> &touching, View<Vec3> elsewhere) const {
    std::vector<Push> found = collect<Push>(int(touching.size()), [&](int k, std::vector<Push> &pushes) {
        const ContactPair &touch = touching[k];
        for_pushing(mesh, touch, elsewhere, [&](const Place &place, double apart, double distance, double barrier_end, double) {
            const Sides of = sides(mesh, touch, place.nearest);
            pushes.push_back({name(touch, place.which),
                              {mesh.object[of.vertex[0]], mesh.object[of.vertex[3]]},
                              place.share * stiffness(of, material),
                              contact_potential(apart, distance, barrier_end).value});
        });
    });
    for_known(contacts_, found, [](const Contact &contact, Push &there) { there.stiffness = contact.stiffness; });
    return found;
}

void ContactSet::find(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &touching,
                      View<Vec3> start, View<Vec3> now) {
    for (const ContactPair &touch : touching) {
        const auto found = early_.find(name(touch));
        if (found == early_.end()) continue;
        Beginning &early = found->second; // stays the same until contacts are found again, whatever stiffness is then
        early.push = distance_to_bear(early.bears / stiffness(sides(mesh, touch, touch.closest), material), early.apart);
    }
    std::vector<Contact> found = of_touching(mesh, material, touching, start, now);
    for_known(expected_, found, [](const Expected &before, Contact &now) { now.grip = before.force; });
    contacts_ = std::move(found);
    expected_.clear();
    for (const Contact &c : contacts_) expected_.push_back({c.pair, c.grip});
    index(mesh);
}

void ContactSet::index(const CollisionMesh &mesh) {
    const int vertices = int(mesh.moves.size());
    roles_ = {size_t(vertices), [&](const auto &work) {
                  for (int k = 0; k < int(contacts_.size()); ++k)
                      for (int i = 0; i < 4; ++i) {
                          const int v = contacts_[k].vertex[i];
                          if (mesh.moves[v] && contacts_[k].weight[i] != 0.0) work(v, Role{k, i});
                      }
              }};
    vertices_.clear();
    for (int v = 0; v < vertices; ++v)
        if (!of(v).empty()) vertices_.push_back(v);
}

} // namespace ringlet
