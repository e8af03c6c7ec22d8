#include "ringlet/groom/keep_beside.h"

#include "ringlet/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ringlet {
namespace {

constexpr double easing = 6e-3;   // [m] length along the lock over which the share of a hair rises from 0 to 1
constexpr double steepness = 2.0; // the margin holds for offsets at least 30° steep; flatter ones may end nearer
constexpr size_t together = 8;    // points per box query
constexpr int rounds = 16;        // of retracting edges
constexpr int gentle = 8;         // of these bisect for the least retraction; the others retract onto the lock
constexpr int halvings = 6;       // steps of the bisection
constexpr size_t few = 8;         // hairs that are not divided further
constexpr size_t crowded = 64;    // triangles near a point of some hairs, on average, from which these are divided

struct Facet {
    Vec3 corner, a, b, normal; // a corner, the edges from it, and their cross product, not normalised
    double area2;
};

Facet facet(const TriangleMesh &mesh, int triangle) {
    const Vec3 &corner = mesh.corner(triangle, 0);
    const Vec3 a = mesh.corner(triangle, 1) - corner, b = mesh.corner(triangle, 2) - corner, normal = a.cross(b);
    return {corner, a, b, normal, normal.squaredNorm()};
}

// Fraction of an offset from a place at which it pierces a triangle; infinity if it does not up to `end`.
double hit_fraction(const Facet &facet, const Vec3 &place, const Vec3 &offset, double end) {
    constexpr double never = std::numeric_limits<double>::infinity(), rim = -1e-9; // leaves no gap between two triangles
    const Vec3 from = place - facet.corner;
    const double height = facet.normal.dot(from), climb = facet.normal.dot(offset);
    if (height * (height + end * climb) > 0.0 || climb == 0.0) return never; // all of it on one side
    const double t = -height / climb;
    const Vec3 at = from + t * offset;
    const double u = at.cross(facet.b).dot(facet.normal), v = facet.a.cross(at).dot(facet.normal);
    return std::min({u, v, facet.area2 - u - v}) < rim * facet.area2 ? never : t;
}

// Largest fraction of an offset from a place that stays on this side of the triangles, `margin` short of their planes.
double free_fraction(const std::vector<Facet> &facets, const Vec3 &place, const Vec3 &offset, double margin) {
    double fraction = 1.0;
    for (const Facet &facet : facets) {
        const double t = hit_fraction(facet, place, offset, 1.0 + steepness * margin / offset.norm());
        if (std::isfinite(t))
            fraction = std::min(fraction, t - margin * facet.normal.norm() / std::abs(facet.normal.dot(offset)));
    }
    return std::max(fraction, 0.0);
}

struct Box {
    Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
    void add(const Vec3f &point) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
};

// The hairs of one lock. Boxes and triangles of a point are those of the edge after it as well.
class LockHairs {
public:
    LockHairs(const HairLayout &layout, const TriangleTree &tree, double margin, float *hairs, std::uint8_t *shares)
        : layout_(layout), tree_(tree), margin_(margin), n_(layout.hold.size()), all_(hairs), shares_(shares), boxes_(n_),
          facets_(n_), places_(n_), hair_(n_), segment_(n_), share_(n_) {}

    // Returns the number of hairs that moved, and writes the shares of their points (of 255) unless these are null.
    int keep_hairs(View<Vec3f> lock, int first, int count) {
        if (lock.size() < 2 || count == 0) return 0;
        order_.resize(count);
        std::iota(order_.begin(), order_.end(), first);
        std::ranges::stable_sort(order_, {}, [&](int hair) { return layout_.join[hair]; });
        return keep_some(lock, order_);
    }

private:
    float *points_of(int hair) const { return all_ + 3 * n_ * hair; }

    // Keeps some hairs of the lock. Those that join a row grow all along it, so that their common box has most triangles of
    // the row: they are halved, in the order in which they join, until few triangles are near.
    int keep_some(View<Vec3f> lock, std::span<const int> some) {
        bound_hairs(some);
        const size_t triangles = find_near_triangles(lock, some);
        if (triangles > crowded * near_.size() && some.size() > few) {
            const size_t half = some.size() / 2;
            return keep_some(lock, some.first(half)) + keep_some(lock, some.subspan(half));
        }
        int moved = 0;
        for (const int hair : near_.empty() ? std::span<const int>() : some) {
            if (!keep_hair(lock, hair)) continue;
            ++moved;
            if (shares_)
                std::ranges::transform(share_, shares_ + n_ * hair,
                                       [](double share) { return static_cast<std::uint8_t>(255.0 * share); });
        }
        return moved;
    }

    // Place on the lock of the k-th point of a hair, in segments from the root.
    float place_along(View<Vec3f> lock, int hair, size_t k) const {
        const float join = layout_.join[hair], last = static_cast<float>(lock.size() - 1), ends = static_cast<float>(n_ - 1);
        const float s = static_cast<float>(k), along = s + layout_.flat[hair] * (layout_.pace[k] * ends - s);
        return join * last + along * ((layout_.tip[hair] - join) * last / ends);
    }

    Vec3f place_on(View<Vec3f> lock, int hair, size_t k, int &segment) const {
        const float at = place_along(lock, hair, k);
        segment = std::min(static_cast<int>(at), static_cast<int>(lock.size()) - 2);
        return lock[segment] + (at - static_cast<float>(segment)) * (lock[segment + 1] - lock[segment]);
    }

    // Sagitta of the parabola through three points of a hair [m]: an eighth of their second difference.
    template <class Points> double bow(const Points &points, size_t k) const {
        if (n_ < 3) return 0.0;
        const auto at = static_cast<Eigen::Index>(std::clamp<size_t>(k, 1, n_ - 2));
        return 0.125 * static_cast<double>((points.col(at - 1) - 2.0f * points.col(at) + points.col(at + 1)).norm());
    }

    // Computes bounds on the k-th points of all hairs, and on their second differences.
    void bound_hairs(std::span<const int> some) {
        const size_t size = 3 * n_;
        low_.assign(points_of(some[0]), points_of(some[0]) + size), high_ = low_;
        bend_.assign(size, 0.0f);
        for (const int hair : some) {
            const float *x = points_of(hair);
            for (size_t j = 0; j < size; ++j) {
                low_[j] = std::min(low_[j], x[j]);
                high_[j] = std::max(high_[j], x[j]);
            }
            for (size_t j = 3; j + 3 < size; ++j) bend_[j] = std::max(bend_[j], std::abs(x[j - 3] - 2.0f * x[j] + x[j + 3]));
        }
    }

    // Finds the triangles near the space between the hairs and their lock at each point. Returns their number over all points.
    size_t find_near_triangles(View<Vec3f> lock, std::span<const int> some) {
        const auto bend = [&](size_t k) { return Eigen::Map<const Vec3f>(&bend_[3 * k]).norm(); };
        const size_t last = lock.size() - 1;
        for (size_t k = 0; k < n_; ++k) {
            const size_t after = std::min(k + 1, n_ - 1);
            float least = static_cast<float>(last), greatest = 0.0f;
            for (const int hair : some) {
                least = std::min(least, place_along(lock, hair, k));
                greatest = std::max(greatest, place_along(lock, hair, after));
            }
            const auto begin = static_cast<size_t>(least);
            const auto end = std::min(static_cast<size_t>(greatest) + 1, last);
            Box box;
            for (size_t j = std::min(begin, last - 1); j <= end; ++j) box.add(lock[j]);
            for (const size_t j : {k, after}) {
                box.add(Eigen::Map<const Vec3f>(&low_[3 * j]));
                box.add(Eigen::Map<const Vec3f>(&high_[3 * j]));
            }
            float most = 0.0f;
            for (size_t j = std::max<size_t>(k, 1) - 1; j <= std::min(k + 2, n_ - 1); ++j) most = std::max(most, bend(j));
            const float wider = static_cast<float>(steepness) * (static_cast<float>(margin_) + 0.125f * most);
            boxes_[k] = {box.low.array() - wider, box.high.array() + wider};
        }
        near_.clear();
        size_t triangles = 0;
        for (size_t begin = 0; begin < n_; begin += together) {
            const size_t end = std::min(begin + together, n_);
            Box all;
            for (size_t k = begin; k < end; ++k) all.add(boxes_[k].low), all.add(boxes_[k].high);
            if (find(all); found_.empty()) continue;
            for (size_t k = begin; k < end; ++k) {
                if (layout_.hold[k] == 1.0f) continue;
                if (find(boxes_[k]); found_.empty()) continue;
                near_.push_back(k);
                triangles += found_.size();
                facets_[k].clear();
                for (const int triangle : found_) facets_[k].push_back(facet(tree_.mesh(), triangle));
            }
        }
        return triangles;
    }
    void find(const Box &box) {
        found_.clear();
        tree_.overlapping(box.low.cast<double>(), box.high.cast<double>(), found_);
    }

    bool keep_hair(View<Vec3f> lock, int number) {
        Eigen::Map<Eigen::Matrix3Xf> points(points_of(number), 3, static_cast<Eigen::Index>(n_));
        std::ranges::fill(share_, 1.0);
        bool separated = false, pierced = false;
        for (const size_t k : near_) {
            int segment;
            const Vec3 place = place_on(lock, number, k, segment).cast<double>(), offset = points.col(k).cast<double>() - place;
            if (offset.isZero(0.0)) continue;
            share_[k] = free_fraction(facets_[k], place, offset, margin_ + bow(points, k));
            separated = separated || share_[k] < 1.0;
        }
        for (const size_t k : near_)
            pierced = pierced || (is_free(k) && pierces(k, points.col(k).cast<double>(), points.col(k + 1).cast<double>()));
        if (!separated && !pierced) return false;
        for (size_t k = 0; k < n_; ++k) {
            places_[k] = place_on(lock, number, k, segment_[k]).cast<double>();
            hair_[k] = points.col(k).cast<double>();
        }
        write(points);
        for (int round = 0; round < rounds && retract_edges(lock, points, round < gentle); ++round) {
        }
        return true;
    }

    // Whether the edge after the k-th point may be retracted.
    bool is_free(size_t k) const { return k + 1 < n_ && layout_.hold[k] == 0.0f; }

    // Whether the edge after the k-th point, with these ends, pierces a triangle.
    bool pierces(size_t k, const Vec3 &from, const Vec3 &to) const {
        return std::ranges::any_of(facets_[k],
                                   [&](const Facet &facet) { return hit_fraction(facet, from, to - from, 1.0) <= 1.0; });
    }

    // Retracts the ends of edges that pierce a triangle, as little as possible or onto the lock. An edge on the lock that cuts
    // one of its corners gets an end in that corner. Returns whether any edge pierced.
    bool retract_edges(View<Vec3f> lock, Eigen::Map<Eigen::Matrix3Xf> &points, bool gently) {
        bool any = false;
        for (const size_t k : near_) {
            if (!is_free(k) || !pierces(k, place(k, 1.0), place(k + 1, 1.0))) continue;
            if (share_[k] + share_[k + 1] == 0.0) places_[k + 1] = lock[segment_[k + 1]].cast<double>();
            const double fraction = gently ? unpierced_fraction(k) : 0.0;
            share_[k] *= fraction, share_[k + 1] *= fraction;
            any = true;
        }
        if (any) write(points);
        return any;
    }

    // Largest fraction of their shares at which the edge after the k-th point does not pierce, by bisection. It depends
    // continuously on the hair, which retraction onto the lock does not.
    double unpierced_fraction(size_t k) const {
        double beside = 0.0, through = 1.0;
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (beside + through);
            (pierces(k, place(k, middle), place(k + 1, middle)) ? through : beside) = middle;
        }
        return beside;
    }

    // The k-th point with that fraction of its share, rounded to single precision as it is written.
    Vec3 place(size_t k, double fraction) const {
        const double share = std::max(fraction * share_[k], static_cast<double>(layout_.hold[k]));
        return (places_[k] + share * (hair_[k] - places_[k])).cast<float>().cast<double>();
    }

    // Limits the change of shares along the hair, and writes its points.
    void write(Eigen::Map<Eigen::Matrix3Xf> &points) {
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
    float *all_;                             // points of the hairs of all locks
    std::uint8_t *shares_;                   // and shares of these points, or null
    std::vector<int> order_;                 // hairs of the lock as they join it
    std::vector<float> low_, high_, bend_;   // bounds on the points of all hairs, and on their second differences
    std::vector<Box> boxes_;                 // around the space between hairs and lock, at each point
    std::vector<std::vector<Facet>> facets_; // triangles near that space, at the points of near_
    std::vector<size_t> near_;               // points with triangles nearby
    std::vector<Vec3> places_, hair_;        // of one hair: places on the lock, and points before retraction [m]
    std::vector<int> segment_, found_;       // segment of the lock for each point; result of a box query
    std::vector<double> share_;              // fraction of the offset from the lock that each point keeps
};

} // namespace

int keep_beside(View<Vec3f> lock_points, View<int> lock_offsets, const HairLayout &layout, const TriangleMesh &surface,
                double margin, std::span<float> hairs, std::span<std::uint8_t> shares) {
    const int locks = static_cast<int>(lock_offsets.size()) - 1;
    const TriangleTree tree(surface);
    int moved = 0;
#pragma omp parallel reduction(+ : moved)
    {
        LockHairs of(layout, tree, margin, hairs.data(), shares.empty() ? nullptr : shares.data());
#pragma omp for schedule(dynamic, 8)
        for (int lock = 0; lock < locks; ++lock) {
            const int first = layout.first[lock], begin = lock_offsets[lock];
            moved += of.keep_hairs(lock_points.subspan(begin, lock_offsets[lock + 1] - begin), first,
                                   layout.first[lock + 1] - first);
        }
    }
    return moved;
}

} // namespace ringlet
