#include "ringlet/groom/curl.h"

#include "ringlet/geometry/resample.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ringlet {
namespace {

double lerp_table(View<double> table, double u) {
    const double at = u * static_cast<double>(table.size() - 1);
    const size_t i = std::min(static_cast<size_t>(at), table.size() - 2);
    return table.size() < 2 ? table[0] : table[i] + (at - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

// Between its values a noise eases in and out, so that it has no corners.
double eased_table(View<double> table, double u) {
    if (table.size() < 2) return table[0];
    const double at = u * static_cast<double>(table.size() - 1);
    const size_t i = std::min(static_cast<size_t>(at), table.size() - 2);
    const double t = at - static_cast<double>(i);
    return table[i] + t * t * (3.0 - 2.0 * t) * (table[i + 1] - table[i]);
}

// One lock being curled; the scratch is kept from lock to lock.
class Curler {
public:
    // Six samples a point: at 12 points a turn the chords between samples miss the curl by a thousandth of its radius.
    Curler(const CurlSettings &settings, int count)
        : settings_(settings), fine_(6 * count), centre_(fine_), tangent_(fine_), axis_(fine_), curled_(fine_) {}

    void operator()(int lock, View<Vec3> shape, std::span<Vec3> result) {
        double length = 0.0;
        for (size_t i = 1; i < shape.size(); ++i) length += (shape[i] - shape[i - 1]).norm();
        const double arc = wind(lock, shape, length, 1.0);
        if (settings_.keep_length && arc > length) {
            // The part of the shape whose curl is as long as the shape was; arc length grows with it.
            double low = 0.0, high = 1.0;
            for (int k = 0; k < 24; ++k) {
                const double middle = 0.5 * (low + high);
                (wind(lock, shape, length, middle) > length ? high : low) = middle;
            }
            wind(lock, shape, length, high);
        }
        space_evenly(curled_, result);
    }

private:
    // Curls the first part of the shape, with all turns in it when they are counted per lock; returns the arc length.
    double wind(int lock, View<Vec3> shape, double length, double part) {
        const size_t n = curled_.size();
        const double step = part / static_cast<double>(n - 1), last = static_cast<double>(shape.size() - 1);
        for (size_t k = 0; k < n; ++k) centre_[k] = spline(shape, std::min(last, last * step * static_cast<double>(k)));
        tangents(centre_, tangent_);
        transport(centre_, tangent_, settings_.axis[lock], axis_);

        const size_t noises = settings_.noise_count;
        const View<double> width_noise = settings_.width_noise.subspan(lock * noises, noises);
        const View<double> rate_noise = settings_.rate_noise.subspan(lock * noises, noises);
        const View<double> hand = settings_.hand.subspan(lock * noises, noises);
        const double per_step = 2.0 * std::numbers::pi * settings_.turns[lock] * step;
        double phase = settings_.phase[lock], arc = 0.0;
        for (size_t k = 0; k < n; ++k) {
            const double u = std::min(1.0, step * static_cast<double>(k));
            const double opened = settings_.start[lock] > 0.0 ? std::min(1.0, u * length / settings_.start[lock]) : 1.0;
            const double radius = settings_.radius[lock] * lerp_table(settings_.width_ramp, u) * opened * opened *
                                  (3.0 - 2.0 * opened) * (1.0 + eased_table(width_noise, u));
            const Vec3 b = tangent_[k].cross(axis_[k]);
            curled_[k] = centre_[k] + radius * (std::cos(phase) * axis_[k] + (1.0 - settings_.flatness) * std::sin(phase) * b);
            if (k > 0) arc += (curled_[k] - curled_[k - 1]).norm();
            phase += per_step * lerp_table(settings_.rate_ramp, u) * (1.0 + eased_table(rate_noise, u)) * eased_table(hand, u);
        }
        return arc;
    }

    const CurlSettings &settings_;
    size_t fine_;
    std::vector<Vec3> centre_, tangent_, axis_, curled_;
};

} // namespace

std::vector<Vec3> curl(const CurveView &shapes, const CurlSettings &settings, int count) {
    std::vector<Vec3> result(static_cast<size_t>(shapes.count()) * count);
#pragma omp parallel
    {
        Curler curler(settings, count);
#pragma omp for schedule(dynamic, 16)
        for (int lock = 0; lock < shapes.count(); ++lock)
            curler(lock, shapes[lock], std::span(result).subspan(static_cast<size_t>(lock) * count, count));
    }
    return result;
}

} // namespace ringlet
