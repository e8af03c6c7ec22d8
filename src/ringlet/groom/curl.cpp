#include "ringlet/groom/curl.h"

#include "ringlet/geometry/resample.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ringlet {
namespace {

constexpr double whole_turn = 2.0 * std::numbers::pi;

double smoothstep(double t) { return t * t * (3.0 - 2.0 * t); }

double smoothstep_over(double s, double whole) { return whole > 0.0 ? smoothstep(std::clamp(s / whole, 0.0, 1.0)) : 1.0; }

double lerp_table(View<double> table, double u) {
    if (table.size() < 2) return table[0];
    const double at = u * static_cast<double>(table.size() - 1);
    const size_t i = std::min(static_cast<size_t>(at), table.size() - 2);
    return table[i] + (at - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

// Sample in the noise tables of all locks, interpolated by a smoothstep, so that noise has no corners.
struct NoiseSample {
    size_t i, next;
    double t;
    NoiseSample(size_t size, double u) {
        const double at = u * static_cast<double>(size - 1);
        i = std::min(static_cast<size_t>(at), size > 1 ? size - 2 : 0);
        next = std::min(i + 1, size - 1);
        t = smoothstep(at - static_cast<double>(i));
    }
    double operator()(View<double> table) const { return table[i] + t * (table[next] - table[i]); }
};

// Shape curve by arc length: the spline through its points with a rotation-minimising frame.
class Spine {
public:
    void fit(View<Vec3> shape, const Vec3 &axis) {
        pieces_ = spline(shape);
        const size_t n = 4 * (shape.size() - 1) + 1;
        for (auto *values : {&points_, &tangents_, &a_, &b_}) values->resize(n);
        along_.assign(n, 0.0);
        for (size_t k = 0; k < n; ++k) points_[k] = on_piece(k, 0.0);
        for (size_t k = 1; k < n; ++k) along_[k] = along_[k - 1] + (points_[k] - points_[k - 1]).norm();
        tangents(points_, tangents_);
        transport(points_, tangents_, axis, a_);
        for (size_t k = 0; k < n; ++k) b_[k] = tangents_[k].cross(a_[k]);
        length_ = 0.0;
        for (size_t i = 1; i < shape.size(); ++i) length_ += (shape[i] - shape[i - 1]).norm();
        i_ = 0;
    }

    double length() const { return length_; }

    // Point and two axes at a fraction (0…1) of the arc length. The search is linear, and fast for ascending fractions.
    void at(double fraction, Vec3 &point, Vec3 &a, Vec3 &b) {
        const double s = fraction * along_.back();
        if (s < along_[i_]) i_ = 0;
        while (i_ + 2 < along_.size() && along_[i_ + 1] < s) ++i_;
        const double edge = along_[i_ + 1] - along_[i_];
        const double t = edge > 0.0 ? std::min(1.0, (s - along_[i_]) / edge) : 0.0;
        point = on_piece(i_, t);
        a = a_[i_] + t * (a_[i_ + 1] - a_[i_]);
        b = b_[i_] + t * (b_[i_ + 1] - b_[i_]);
    }

private:
    // The spline at a fraction of the step after a sample; each piece of the spline has four samples.
    Vec3 on_piece(size_t point, double fraction) const {
        const size_t piece = std::min(point / 4, pieces_.size() - 1);
        return pieces_[piece](0.25 * (static_cast<double>(point - 4 * piece) + fraction));
    }

    std::vector<Cubic> pieces_;
    std::vector<Vec3> points_, tangents_, a_, b_;
    std::vector<double> along_;
    double length_ = 0.0;
    size_t i_ = 0;
};

// Sample of the curl's centre line with frame, phase and radius.
struct Sample {
    Vec3 centre, a, b;
    double phase, radius;
};

// Curls one lock after the other, with the same scratch memory.
class Curler {
public:
    // Two samples a point with a spline between them: at 12 points a turn the error is 1e-4 of the radius.
    Curler(const CurveView &shapes, const CurlSettings &settings, int count)
        : shapes_(shapes), settings_(settings), path_(2 * count), leader_path_(2 * count), curled_(2 * count) {
        for (size_t k = 0; k < path_.size(); ++k) {
            const double v = static_cast<double>(k) / static_cast<double>(path_.size() - 1);
            shared_.push_back({v, lerp_table(settings.width_ramp, v), lerp_table(settings.rate_ramp, v),
                               lerp_table(settings.taper_ramp, v), lerp_table(settings.wave_ramp, v),
                               NoiseSample(settings.noise_count, v)});
        }
    }

    void operator()(int lock, std::span<Vec3> result) {
        lock_ = lock;
        spine_.fit(shapes_[lock], settings_.axis[lock]);
        if (const int leader = settings_.leader[lock]; leader != lock)
            leader_spine_.fit(shapes_[leader], settings_.axis[leader]);
        const double over = wind(1.0, result) - spine_.length();
        if (settings_.keep_length && over > 0.0) shorten(over, result);
    }

private:
    // Finds the fraction of the shape whose curl has the length of the shape, by regula falsi (Illinois method).
    void shorten(double over_high, std::span<Vec3> result) {
        double low = 0.0, high = 1.0, over_low = -spine_.length();
        int moved = 0; // the end of the interval that the last step moved: −1 low, 1 high
        for (int k = 0; k < 30; ++k) {
            const double x = (low * over_high - high * over_low) / (over_high - over_low);
            const double over = wind(x, result) - spine_.length();
            if (std::abs(over) < 1e-6 * spine_.length()) return;
            if (over < 0.0) {
                low = x, over_low = over;
                if (moved < 0) over_high *= 0.5;
                moved = -1;
            } else {
                high = x, over_high = over;
                if (moved > 0) over_low *= 0.5;
                moved = 1;
            }
        }
    }

    // Curls the first fraction of the shape; returns the length of the curl.
    double wind(double share, std::span<Vec3> result) {
        // A fixed number of turns may be too long for the length that is left: then they get narrower instead of denser.
        constexpr double least = 0.05;
        const double fraction = std::max(share, least), narrower = std::min(1.0, share / least);
        sample_path(lock_, spine_, fraction, path_);
        const int leader = settings_.leader[lock_];
        if (leader != lock_) {
            sample_path(leader, leader_spine_, fraction, leader_path_);
            join_leader(fraction);
        }
        const double flat = 1.0 - settings_.flatness[lock_], kink = settings_.kink[lock_];
        for (size_t k = 0; k < path_.size(); ++k) {
            const Sample &at = path_[k];
            const double across = std::cos(at.phase), up = std::sin(at.phase);
            // Zigzag with slightly rounded corners: its slope changes over a tenth of a period.
            const double zigzag = kink > 0.0 ? std::asin(0.985 * across) / std::asin(0.985) : 0.0;
            curled_[k] = at.centre + narrower * at.radius *
                                         (((1.0 - kink) * across + kink * zigzag) * at.a + (1.0 - kink) * flat * up * at.b);
        }
        space_evenly(curled_, result);
        double length = 0.0;
        for (size_t k = 1; k < result.size(); ++k) length += (result[k] - result[k - 1]).norm();
        return length;
    }

    // Samples centre line, frame, phase and radius of a lock on the first fraction of its shape.
    void sample_path(int lock, Spine &spine, double fraction, std::span<Sample> path) const {
        const size_t noises = settings_.noise_count, events = settings_.event_count;
        const View<double> width_noise = settings_.width_noise.subspan(lock * noises, noises);
        const View<double> rate_noise = settings_.rate_noise.subspan(lock * noises, noises);
        const View<double> sway = settings_.sway.subspan(lock * noises, noises);
        const View<double> switchbacks = settings_.switchbacks.subspan(lock * events, events);
        const View<double> skips = settings_.skips.subspan(lock * events, events);
        const double turns = settings_.turns[lock] * (settings_.counted ? 1.0 : fraction);
        const double length = fraction * spine.length(), step = 1.0 / static_cast<double>(path.size() - 1);
        const double wave_turns = settings_.wave_turns[lock] * fraction, wave = settings_.wave[lock];
        const double wave_x = std::cos(settings_.phase[lock]), wave_y = std::sin(settings_.phase[lock]);

        double turned = 0.0, rate_before = 0.0;
        for (size_t k = 0; k < path.size(); ++k) {
            const auto &[v, width_ramp, rate_ramp, taper_ramp, wave_ramp, noise] = shared_[k];
            const double s = v * length;
            Sample &at = path[k];
            spine.at(v * fraction, at.centre, at.a, at.b);
            // A closing over less than 2 mm has less weight, so that the tip does not jump when `end` leaves 0.
            double open = lerp_table(settings_.opening, smoothstep_over(s, settings_.start[lock]));
            if (const double end = settings_.end[lock]; end > 0.0) {
                const double closing = lerp_table(settings_.closing, 1.0 - smoothstep_over(length - s, end));
                open *= 1.0 + std::min(1.0, end / 2e-3) * (closing - 1.0);
            }
            at.radius = settings_.radius[lock] * width_ramp * open * (1.0 - settings_.taper[lock] * taper_ramp) *
                        (1.0 + noise(width_noise));
            const double rate = turns * rate_ramp * (1.0 + noise(rate_noise)) *
                                hand(settings_.flip[lock], switchbacks, turns, v) * skip_factor(skips, turns, v);
            if (k > 0) turned += 0.5 * step * (rate_before + rate);
            rate_before = rate;
            at.phase = settings_.phase[lock] + whole_turn * turned;
            if (wave > 0.0)
                at.centre += wave * wave_ramp * open * std::sin(whole_turn * wave_turns * v) * (wave_x * at.a + wave_y * at.b);
            if (const double angle = noise(sway); angle != 0.0) {
                const Vec3 a = std::cos(angle) * at.a + std::sin(angle) * at.b;
                at.b = std::cos(angle) * at.b - std::sin(angle) * at.a;
                at.a = a;
            }
        }
    }

    // +1 before and -1 after a place where the hand changes; the transition takes about a turn.
    static double sign_after(double place, double turns, double v) {
        return 1.0 - 2.0 * smoothstep(std::clamp(0.5 + (v - place) * std::max(turns, 1.0), 0.0, 1.0));
    }

    static double hand(double flip, View<double> switchbacks, double turns, double v) {
        double result = -sign_after(flip, turns, v);
        for (const double place : switchbacks) {
            if (place > 2.0) break; // places ascend
            result *= sign_after(place, turns, v);
        }
        return result;
    }

    // Factor on the rate of turning: 1, and less over two turns around a skip, so that one turn is left out.
    static double skip_factor(View<double> skips, double turns, double v) {
        double left_out = 0.0;
        for (const double at : skips) {
            if (at > 2.0) break;
            const double t = 0.5 * (v - at) * std::max(turns, 1.0); // -½ … ½ over two turns
            if (std::abs(t) < 0.5) left_out += 0.5 + 0.5 * std::cos(whole_turn * t);
        }
        return std::max(0.0, 1.0 - left_out);
    }

    // Blends phase, radius and centre line into those of the leader.
    void join_leader(double fraction) {
        const double length = fraction * spine_.length(), cohesion = settings_.cohesion[lock_];
        for (size_t k = 0; k < path_.size(); ++k) {
            const double s = length * static_cast<double>(k) / static_cast<double>(path_.size() - 1);
            const double weight = settings_.join[lock_] * smoothstep_over(s, settings_.join_over[lock_]);
            Sample &own = path_[k];
            const Sample &other = leader_path_[k];
            own.phase += weight * (other.phase - own.phase);
            own.radius += weight * (other.radius - own.radius);
            own.centre += weight * cohesion * (other.centre - own.centre);
            const Vec3 tangent = own.a.cross(own.b);
            own.a = orthogonal(own.a + weight * (other.a - own.a), tangent);
            own.b = tangent.cross(own.a);
        }
    }

    const CurveView &shapes_;
    const CurlSettings &settings_;
    int lock_ = 0;
    Spine spine_, leader_spine_;
    std::vector<Sample> path_, leader_path_;
    std::vector<Vec3> curled_;
    struct Shared {
        double v, width_ramp, rate_ramp, taper_ramp, wave_ramp;
        NoiseSample noise;
    };
    std::vector<Shared> shared_; // values that all locks share, per sample
};

} // namespace

std::vector<Vec3> curl(const CurveView &shapes, const CurlSettings &settings, int count) {
    std::vector<Vec3> result(static_cast<size_t>(shapes.count()) * count);
#pragma omp parallel
    {
        Curler curler(shapes, settings, count);
#pragma omp for schedule(dynamic, 16)
        for (int lock = 0; lock < shapes.count(); ++lock)
            curler(lock, std::span(result).subspan(static_cast<size_t>(lock) * count, count));
    }
    return result;
}

} // namespace ringlet
