// Continuations of the hinge model: signs of its corners and turns of its edges.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/energy/strand/twist.h"
#include "ringlet/strand/hinge/vertex_data.h"

#include <numbers>

// Constants that decide how hinges behave, with their units.
namespace ringlet::hinge_settings {

inline constexpr double normal_sine = 2.6e-3; // a corner has a normal of its own from this sine on

// Corners that are too straight, or folded, to have a plane
inline constexpr double straight_angle = 0.15 * std::numbers::pi / 180;      // no twist below this angle [rad]
inline constexpr double straight_fade_angle = 0.30 * std::numbers::pi / 180; // full twist from here on (`history`) [rad]
inline constexpr double straight_rest_angle = 0.3 * std::numbers::pi / 180;  // no sign below (`least_energy`) [rad]
inline constexpr double excluded_energy = 1e30;                              // of a sign that may not be chosen [J]

} // namespace ringlet::hinge_settings

namespace ringlet::RINGLET_SIMD {

// `history`: signs and turns follow those of the last accepted step. Safeguards keep virtual triangles that degenerate or flip
// harmless. The fade of the twist is constant within a step.

// Sign of a corner's bend. A normal that reverses is its virtual triangle inverting, as where a curl passes through straight,
// and not half a turn of twist. The last normal is first transported with the edge, so that a fast rotation of the strand is
// no flip.
template <class T> inline T transported_sign(const Reference<T> &reference, Vec<T> tangent, Vec<T> normal) {
    return sign(dot(normal, transport(reference.normal, reference.tangent, tangent)));
}

// Δφ with its turns: of all values whole turns apart, the one nearest to that of the last step. Twist accumulates past ±π.
// Where one of the two triangles is inverted (signs differ), the dihedral is half a turn off.
template <class T> inline T unwrapped(T last, T delta, T sign_product) {
    const T with_sign = delta + select(sign_product < 0.0, constant<T>(pi), T{});
    return last + wrap(with_sign - last);
}

// Factor on the twist of an edge with a corner that is nearly straight or folded: 0 below `straight_angle`, then a smooth rise
// to 1 at `straight_fade_angle`. A hard cut would remove a large stiffness at once.
template <class T> inline T straightness_fade(T angle) {
    const double low = hinge_settings::straight_angle, high = hinge_settings::straight_fade_angle;
    const T u = (min(angle, pi - angle) - low) * (1.0 / (high - low));
    const T y = min(max(u, T{}), constant<T>(1.0));
    return y * y * (3.0 - 2.0 * y);
}

template <class T> void continue_history(int vertices, const HingeRow<T> *rows, HingeShape<T> *shapes, Safeguards safeguards) {
    for (int i = 1; i + 1 < vertices; ++i)
        shapes[i].sigma = safeguards.flip_history
                              ? transported_sign(rows[i].reference, shapes[i].tangent, shapes[i].corner.normal)
                              : constant<T>(1.0);
    for (int i = 1; i + 2 < vertices; ++i) {
        HingeShape<T> &s = shapes[i];
        const T delta = s.phi - rows[i].rest_dihedral;
        s.delta = unwrapped(safeguards.winding_number ? rows[i].reference_delta : T{}, delta, s.sigma * shapes[i + 1].sigma);
        s.turns = round((s.delta - delta) * (0.5 / pi));
        s.strain = rows[i].fade * s.delta;
        s.by_dihedral = rows[i].fade;
        s.by_angle = s.by_next = T{};
    }
}

// `least_energy`: the signs that give the strand the least energy, as part of the energy itself.
//   E = min over σ of Σ ½ k_b (σθ − θ̄)² + Σ ½ k_t [s(θ_a) s(θ_b) f(Δ)]²,  Δ = wrap(φ − φ̄ + π [σ_a σ_b < 0])
// It is a continuous function of the positions alone: it has no history, and no step can add energy.
// Dynamic programming over two states per corner finds the exact minimum. Derivatives keep the signs (envelope theorem).

template <class T> struct WithSlope {
    T value, slope;
};

// f(Δ): Δ up to a quarter turn, then a sine that is level at ±π. The energy has no kink where Δ wraps.
template <class T> inline WithSlope<T> rounded(T delta) {
    const T beyond = abs(delta) - pi / 2;
    const SineCosine<T> end = sine_cosine_quarter(min(max(beyond, T{}), constant<T>(pi / 2)));
    const auto past_quarter = beyond > 0.0;
    return {select(past_quarter, sign(delta) * (pi / 2 + end.sine), delta), select(past_quarter, end.cosine, constant<T>(1.0))};
}

// s(θ): 0 where a corner is within `straight_angle` of straight or folded, 1 from half the rest angle on.
template <class T> inline WithSlope<T> straightness(T angle, T rest_angle) {
    const double low = hinge_settings::straight_angle;
    const T high = max(0.5 * min(rest_angle, pi - rest_angle), constant<T>(2 * low));
    const T inverse = 1.0 / (high - low);
    const T y = min(max((min(angle, pi - angle) - low) * inverse, T{}), constant<T>(1.0));
    const T slope = select(y > 0.0, (1.5 - 1.5 * y * y) * inverse, T{});
    return {y * (1.5 - 0.5 * y * y), select(angle > pi / 2, -slope, slope)};
}

template <class T> void continue_least_energy(int vertices, const HingeRow<T> *rows, HingeShape<T> *shapes) {
    const T one = constant<T>(1.0);
    const int last = vertices - 2; // corners are 1 … last

    const auto bend_of = [&](int i, double sigma) {
        const T energy = bend_energy(shapes[i].corner.angle, constant<T>(sigma), rows[i].damped_angle, rows[i].bend_stiffness);
        return sigma > 0 ? energy
                         : select(rows[i].rest_angle < hinge_settings::straight_rest_angle,
                                  constant<T>(hinge_settings::excluded_energy), energy);
    };
    T plus = bend_of(1, 1), minus = bend_of(1, -1);
    for (int i = 1; i < last; ++i) {
        HingeShape<T> &s = shapes[i], &next = shapes[i + 1];
        const T fade = straightness(s.corner.angle, rows[i].rest_angle).value *
                       straightness(next.corner.angle, rows[i + 1].rest_angle).value;
        const T delta = wrap(s.phi - rows[i].rest_dihedral);
        const T same = twist_energy(fade * rounded(delta).value - rows[i].damped_strain, rows[i].twist_stiffness);
        const T differ = twist_energy(fade * rounded(wrap(delta + pi)).value - rows[i].damped_strain, rows[i].twist_stiffness);
        const auto keep_plus = plus + same <= minus + differ;
        const auto keep_minus = minus + same < plus + differ;
        next.choice_plus = select(keep_plus, one, -one);
        next.choice_minus = select(keep_minus, -one, one);
        const T to_plus = min(plus + same, minus + differ), to_minus = min(minus + same, plus + differ);
        plus = to_plus + bend_of(i + 1, 1);
        minus = to_minus + bend_of(i + 1, -1);
    }
    shapes[last].sigma = select(plus <= minus, one, -one);
    for (int i = last; i > 1; --i)
        shapes[i - 1].sigma = select(shapes[i].sigma > 0.0, shapes[i].choice_plus, shapes[i].choice_minus);

    for (int i = 1; i < last; ++i) {
        HingeShape<T> &s = shapes[i];
        const HingeShape<T> &next = shapes[i + 1];
        const WithSlope<T> a = straightness(s.corner.angle, rows[i].rest_angle),
                           b = straightness(next.corner.angle, rows[i + 1].rest_angle);
        s.delta = wrap(s.phi - rows[i].rest_dihedral + select(s.sigma * next.sigma < 0.0, constant<T>(pi), T{}));
        s.turns = T{};
        const WithSlope<T> f = rounded(s.delta);
        s.strain = a.value * b.value * f.value;
        s.by_dihedral = a.value * b.value * f.slope;
        s.by_angle = a.slope * b.value * f.value;
        s.by_next = a.value * b.slope * f.value;
    }
}

} // namespace ringlet::RINGLET_SIMD
