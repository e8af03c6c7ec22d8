#include "ringlet/geometry/near_segments.h"

#include "ringlet/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace ringlet {
namespace {

// Piece of a segment, at most one median segment long, and the grid cell of its midpoint.
struct Piece {
    std::array<int, 3> cell;
    int segment;
    bool operator<(const Piece &other) const { return std::tie(cell, segment) < std::tie(other.cell, other.segment); }
};

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Hashed uniform grid over the pieces; pairs are searched in neighbouring cells.
class Search {
public:
    Search(const CurveView &curves, double within, double along)
        : curves_(curves), within_(within), along_(along), arc_length_(curves.points.size(), 0.0),
          curve_(curves.points.size()) {
        std::vector<double> lengths;
        for (int i = 0; i < curves.count(); ++i)
            for (int k = curves.offsets[i]; k < curves.offsets[i + 1]; ++k) {
                curve_[k] = i;
                if (k == curves.offsets[i]) continue;
                lengths.push_back((curves.points[k] - curves.points[k - 1]).norm());
                arc_length_[k] = arc_length_[k - 1] + lengths.back();
            }
        const double longest = std::max(median(std::move(lengths)), 1e-6);
        cell_ = longest + within; // no pair of pieces within the distance has midpoints farther apart
        cut(longest);
    }

    std::vector<std::array<int, 2>> pairs() const {
        std::vector<std::array<int, 2>> result;
#pragma omp parallel
        {
            std::vector<std::array<int, 2>> found;
#pragma omp for schedule(dynamic, 256) nowait
            for (size_t k = 0; k < cells_.size() - 1; ++k) search(k, found);
#pragma omp critical
            result.insert(result.end(), found.begin(), found.end());
        }
        std::sort(result.begin(), result.end());
        result.erase(std::unique(result.begin(), result.end()), result.end()); // long segments pair up in several cells
        return result;
    }

private:
    void cut(double longest) {
        for (int i = 0; i < curves_.count(); ++i)
            for (int k = curves_.offsets[i]; k + 1 < curves_.offsets[i + 1]; ++k) {
                const Vec3 &from = curves_.points[k], edge = curves_.points[k + 1] - from;
                const int count = std::max(1, static_cast<int>(std::ceil(edge.norm() / longest - 1e-9)));
                for (int piece = 0; piece < count; ++piece) {
                    const Eigen::Array3d at = (from + ((piece + 0.5) / count) * edge).array() / cell_;
                    const Eigen::Array3i cell = at.floor().cast<int>();
                    pieces_.push_back({{cell[0], cell[1], cell[2]}, k});
                }
            }
        std::sort(pieces_.begin(), pieces_.end());
        for (size_t i = 0; i < pieces_.size(); ++i)
            if (i == 0 || pieces_[i].cell != pieces_[i - 1].cell) cells_.push_back(i);
        cells_.push_back(pieces_.size());
    }

    // Pairs within one cell, and between it and those of its neighbours that come after it in the order of cells.
    void search(size_t k, std::vector<std::array<int, 2>> &found) const {
        const std::span<const Piece> here = in(k);
        for (size_t i = 0; i < here.size(); ++i)
            for (size_t j = i + 1; j < here.size(); ++j) test_pair(here[i].segment, here[j].segment, found);
        const std::array<int, 3> &cell = here[0].cell;
        for (int x = 0; x <= 1; ++x)
            for (int y = x > 0 ? -1 : 0; y <= 1; ++y) {
                // Three cells along the last axis are contiguous in the order of cells.
                const int first = x > 0 || y > 0 ? -1 : 1;
                const std::array<int, 3> begin = {cell[0] + x, cell[1] + y, cell[2] + first};
                const std::array<int, 3> last = {cell[0] + x, cell[1] + y, cell[2] + 1};
                for (size_t other = at_or_after(begin, k); other + 1 < cells_.size() && in(other)[0].cell <= last; ++other)
                    for (const Piece &a : here)
                        for (const Piece &b : in(other)) test_pair(a.segment, b.segment, found);
            }
    }

    void test_pair(int a, int b, std::vector<std::array<int, 2>> &found) const {
        if (a == b) return;
        if (a > b) std::swap(a, b);
        if (curve_[a] == curve_[b] && (b - a < 2 || arc_length_[b] - arc_length_[a + 1] <= along_)) return;
        const View<Vec3> &p = curves_.points;
        if (closest_edge_edge(p[a], p[a + 1], p[b], p[b + 1]).distance2 < within_ * within_) found.push_back({a, b});
    }

    std::span<const Piece> in(size_t k) const { return std::span(pieces_).subspan(cells_[k], cells_[k + 1] - cells_[k]); }

    size_t at_or_after(const std::array<int, 3> &cell, size_t from) const {
        const auto begin = cells_.begin() + static_cast<std::ptrdiff_t>(from), end = cells_.end() - 1;
        const auto before = [&](size_t piece, const std::array<int, 3> &at) { return pieces_[piece].cell < at; };
        return static_cast<size_t>(std::lower_bound(begin, end, cell, before) - cells_.begin());
    }

    const CurveView &curves_;
    double within_, along_, cell_ = 1.0;
    std::vector<double> arc_length_; // from the root to each point [m]
    std::vector<int> curve_;
    std::vector<Piece> pieces_;
    std::vector<size_t> cells_; // first piece of each cell
};

} // namespace

std::vector<std::array<int, 2>> near_segments(const CurveView &curves, double within, double along) {
    return Search(curves, within, along).pairs();
}

} // namespace ringlet
