// SIMD vector of floats, of the width of the instruction set that a kernel is compiled for. Included by *.simd.cpp alone.
#pragma once

#include <cstring>
#if defined(RINGLET_SIMD_avx512) || defined(RINGLET_SIMD_avx2)
#include <immintrin.h>
#endif

namespace ringlet::RINGLET_SIMD {

#if defined(RINGLET_SIMD_avx512)
constexpr int width = 16;
#elif defined(RINGLET_SIMD_avx2)
constexpr int width = 8;
#else
constexpr int width = 4;
#endif
using Floats = float __attribute__((vector_size(4 * width)));
using Bits = int __attribute__((vector_size(4 * width))); // all set where true

inline Floats read(const float *numbers) {
    Floats result;
    std::memcpy(&result, numbers, sizeof(result));
    return result;
}

// The four numbers, repeated over the whole vector.
inline Floats repeat(const float *four) {
#if defined(RINGLET_SIMD_avx512)
    return _mm512_maskz_broadcast_f32x4(0xffff, _mm_loadu_ps(four)); // without a mask GCC 12 warns
#elif defined(RINGLET_SIMD_avx2)
    return _mm256_broadcast_ps(reinterpret_cast<const __m128 *>(four));
#else
    return read(four);
#endif
}

inline Floats lesser(Floats a, Floats b) { return a < b ? a : b; }
inline Floats greater(Floats a, Floats b) { return a > b ? a : b; }

// Bit mask of the lanes that are true.
inline unsigned lanes_of(Bits where) {
#if defined(RINGLET_SIMD_avx512)
    return __builtin_ia32_cvtd2mask512(where);
#elif defined(RINGLET_SIMD_avx2)
    return unsigned(__builtin_ia32_movmskps256(reinterpret_cast<Floats>(where)));
#else
    unsigned all = 0;
    for (int lane = 0; lane < width; ++lane) all |= unsigned(where[lane] & 1) << lane;
    return all;
#endif
}

} // namespace ringlet::RINGLET_SIMD
