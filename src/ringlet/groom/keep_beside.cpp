#include "ringlet/groom/keep_beside.h"

#include "ringlet/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {
namespace {

constexpr double easing = 6e-3; // [m] length along the lock over which a hair comes from its lock to its place
constexpr double slant = 2.0;   // a way to a hair that climbs less than half its length may end nearer than the margin
constexpr int rounds = 16;      // of drawing edges nearer
constexpr int gentle = 8;       // of these go only as far as they must
constexpr int halvings = 6;     // to find how far that is

struct Facet {
    Vec3 corner, a, b, normal; // a corner, the edges from it, and their product, not of length 1
    double area2;
};

Facet facet(const TriangleMesh &mesh, int triangle) {
    const Vec3 &corner = mesh.corner(triangle, 0);
    const Vec3 a = mesh.corner(triangle, 1) - corner, b = mesh.corner(triangle, 2) - corner, normal = a.cross(b);
    return {corner, a, b, normal, normal.squaredNorm()};
}

// Where a way from a place goes through a triangle, as a part of the way; infinity: nowhere up to `end`.
double meets(const Facet &facet, const Vec3 &place, const Vec3 &way, double end) {
    constexpr double never = std::numeric_limits<double>::infinity(), rim = -1e-9; // no gap between two triangles
    const Vec3 from = place - facet.corner;
    const double height = facet.normal.dot(from), climb = facet.normal.dot(way);
    if (height * (height + end * climb) > 0.0 || climb == 0.0) return never; // on one side all the way
    const double t = -height / climb;
    const Vec3 at = from + t * way;
    const double u = at.cross(facet.b).dot(facet.normal), v = facet.a.cross(at).dot(facet.normal);
    return std::min({u, v, facet.area2 - u - v}) < rim * facet.area2 ? never : t;
}

// The part of a way from a place that stays on this side of triangles, and as far as `margin` from their planes.
double free_part(const std::vector<Facet> &facets, const Vec3 &place, const Vec3 &way, double margin) {
    double part = 1.0;
    for (const Facet &facet : facets) {
        const double t = meets(facet, place, way, 1.0 + slant * margin / way.norm());
        if (std::isfinite(t)) part = std::min(part, t - margin * facet.normal.norm() / std::abs(facet.normal.dot(way)));
    }
    return std::max(part, 0.0);
}

struct Box {
    Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
    void add(const Vec3f &point) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
};

// The hairs of one lock, whose points are told by the segment of the lock that they belong to.
class LockHairs {
public:
    LockHairs(const HairLayout &layout, const TriangleTree &tree, double margin)
        : layout_(layout), tree_(tree), margin_(margin), n_(layout.hold.size()), places_(n_), hair_(n_), segment_(n_),
          share_(n_) {}

    int keep(View<Vec3f> lock, int first, int count, float *hairs) {
        if (lock.size() < 2 || !come_near(lock, first, count, hairs)) return 0;
        int moved = 0;
        for (int i = 0; i < count; ++i) moved += keep_one(lock, layout_.tip[first + i], hairs + 3 * n_ * i);
        return moved;
    }

private:
    Vec3f place_on(View<Vec3f> lock, float tip, size_t k, int &segment) const {
        const int last = static_cast<int>(lock.size()) - 1;
        const float at = static_cast<float>(k) * (tip * static_cast<float>(last) / static_cast<float>(n_ - 1));
        segment = std::min(static_cast<int>(at), last - 1);
        return lock[segment] + (at - static_cast<float>(segment)) * (lock[segment + 1] - lock[segment]);
    }

    // How far a smooth curve through the points goes out between them near the k-th [m]: a parabola, by an eighth of the second
    // difference.
    template <class Points> double bow(const Points &points, size_t k) const {
        if (n_ < 3) return 0.0;
        const auto at = static_cast<Eigen::Index>(std::clamp<size_t>(k, 1, n_ - 2));
        return 0.125 * static_cast<double>((points.col(at - 1) - 2.0f * points.col(at) + points.col(at + 1)).norm());
    }

    // Finds the triangles near what is between the hairs and each segment of their lock; returns whether there are any.
    bool come_near(View<Vec3f> lock, int first, int count, const float *hairs) {
        boxes_.assign(lock.size() - 1, {});
        facets_.resize(std::max(facets_.size(), boxes_.size()));
        double most = 0.0;
        for (int i = 0; i < count; ++i) {
            const Eigen::Map<const Eigen::Matrix3Xf> points(hairs + 3 * n_ * i, 3, static_cast<Eigen::Index>(n_));
            int before = 0;
            for (size_t k = 0; k < n_; ++k) {
                most = std::max(most, bow(points, k));
                int segment;
                const Vec3f place = place_on(lock, layout_.tip[first + i], k, segment), point = points.col(k);
                for (const int of : {before, segment}) { // an edge is asked about where it begins
                    boxes_[of].add(place);
                    boxes_[of].add(point);
                    if (before == segment) break;
                }
                before = segment;
            }
        }
        bool any = false;
        for (size_t i = 0; i < boxes_.size(); ++i) {
            facets_[i].clear();
            if (boxes_[i].low[0] > boxes_[i].high[0]) continue; // no hair has a point there
            found_.clear();
            const double wider = slant * (margin_ + most);
            tree_.overlapping(boxes_[i].low.cast<double>().array() - wider, boxes_[i].high.cast<double>().array() + wider,
                              found_);
            for (const int triangle : found_) facets_[i].push_back(facet(tree_.mesh(), triangle));
            any = any || !found_.empty();
        }
        return any;
    }

    bool keep_one(View<Vec3f> lock, float tip, float *hair) {
        Eigen::Map<Eigen::Matrix3Xf> points(hair, 3, static_cast<Eigen::Index>(n_));
        bool moves = false;
        for (size_t k = 0; k < n_; ++k) {
            places_[k] = place_on(lock, tip, k, segment_[k]).cast<double>();
            hair_[k] = points.col(k).cast<double>();
            const Vec3 way = hair_[k] - places_[k];
            share_[k] = 1.0;
            if (way.isZero(0.0) || layout_.hold[k] == 1.0f) continue;
            share_[k] = free_part(facets_[segment_[k]], places_[k], way, margin_ + bow(points, k));
            moves = moves || share_[k] < 1.0;
        }
        if (moves) draw(points);
        for (int round = 0; round < rounds && draw_edges(lock, points, round < gentle); ++round) moves = true;
        return moves;
    }

    // Draws the ends of edges that go through towards the lock, as far as they must or all the way, and those that lie on the
    // lock already and cut one of its corners into that corner; returns whether there were any.
    bool draw_edges(View<Vec3f> lock, Eigen::Map<Eigen::Matrix3Xf> &points, bool gently) {
        bool any = false;
        for (size_t k = 0; k + 1 < n_; ++k) {
            if (facets_[segment_[k]].empty() || layout_.hold[k] > 0.0f || !goes_through(k, 1.0)) continue;
            if (share_[k] + share_[k + 1] == 0.0) places_[k + 1] = lock[segment_[k + 1]].cast<double>();
            const double part = gently ? part_beside(k) : 0.0;
            share_[k] *= part, share_[k + 1] *= part;
            any = true;
        }
        if (any) draw(points);
        return any;
    }

    // Whether the edge after the k-th point goes through a triangle where its ends have such a part of their shares.
    bool goes_through(size_t k, double part) const {
        const Vec3 from = place(k, part), way = place(k + 1, part) - from;
        return std::ranges::any_of(facets_[segment_[k]],
                                   [&](const Facet &facet) { return meets(facet, from, way, 1.0) <= 1.0; });
    }

    // The part of their shares at which the edge after the k-th point does not go through: what moves little changes it little.
    double part_beside(size_t k) const {
        double beside = 0.0, through = 1.0;
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (beside + through);
            (goes_through(k, middle) ? through : beside) = middle;
        }
        return beside;
    }

    // Where the k-th point is, as it is written, with such a part of its share.
    Vec3 place(size_t k, double part) const {
        const double share = std::max(part * share_[k], static_cast<double>(layout_.hold[k]));
        return (places_[k] + share * (hair_[k] - places_[k])).cast<float>().cast<double>();
    }

    // Lets shares change slowly along the hair and puts it there.
    void draw(Eigen::Map<Eigen::Matrix3Xf> &points) {
        for (size_t k = 1; k < n_; ++k) share_[k] = std::min(share_[k], share_[k - 1] + rise(k));
        for (size_t k = n_ - 1; k-- > 0;) share_[k] = std::min(share_[k], share_[k + 1] + rise(k + 1));
        for (size_t k = 0; k < n_; ++k) {
            share_[k] = std::max(share_[k], static_cast<double>(layout_.hold[k]));
            if (share_[k] < 1.0) points.col(k) = place(k, 1.0).cast<float>();
        }
    }
    double rise(size_t k) const { return (places_[k] - places_[k - 1]).norm() / easing; }

    const HairLayout &layout_;
    const TriangleTree &tree_;
    double margin_;
    size_t n_;                               // points of a hair
    std::vector<Vec3> places_, hair_;        // on the lock, and where the hair would be [m]
    std::vector<int> segment_, found_;       // of the lock, for each point
    std::vector<double> share_;              // of the way from the lock to there
    std::vector<Box> boxes_;                 // around what is between hairs and lock, per segment of the lock
    std::vector<std::vector<Facet>> facets_; // near it
};

} // namespace

int keep_beside(View<Vec3f> lock_points, View<int> lock_offsets, const HairLayout &layout, const TriangleMesh &surface,
                double margin, std::span<float> hairs) {
    const int locks = static_cast<int>(lock_offsets.size()) - 1;
    const TriangleTree tree(surface);
    int moved = 0;
#pragma omp parallel reduction(+ : moved)
    {
        LockHairs of(layout, tree, margin);
#pragma omp for schedule(dynamic, 8)
        for (int lock = 0; lock < locks; ++lock) {
            const int first = layout.first[lock], begin = lock_offsets[lock];
            moved += of.keep(lock_points.subspan(begin, lock_offsets[lock + 1] - begin), first, layout.first[lock + 1] - first,
                             hairs.data() + 3 * layout.hold.size() * first);
        }
    }
    return moved;
}

} // namespace ringlet
