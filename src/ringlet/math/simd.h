// Instruction set that the kernels in *.simd.cpp run on; chosen once, at first use.
#pragma once

namespace ringlet {

enum class Simd { baseline, avx2, avx512 };

// The widest set that this build and this processor support. The environment variable RINGLET_SIMD (baseline, avx2, avx512)
// lowers it, to test one set against another.
Simd simd();
const char *simd_name(Simd set);

} // namespace ringlet

// Calls FUNCTION from the namespace of the chosen set: RINGLET_DISPATCH(step, arguments...).
#ifdef RINGLET_SIMD_X86
#define RINGLET_DISPATCH(function, ...)                                                                                        \
    (::ringlet::simd() == ::ringlet::Simd::avx512 ? ::ringlet::avx512::function(__VA_ARGS__)                                   \
     : ::ringlet::simd() == ::ringlet::Simd::avx2 ? ::ringlet::avx2::function(__VA_ARGS__)                                     \
                                                  : ::ringlet::baseline::function(__VA_ARGS__))
// Declares FUNCTION in every namespace: RINGLET_DECLARE(void step(Batch &batch);)
#define RINGLET_DECLARE(...)                                                                                                   \
    namespace baseline {                                                                                                       \
    __VA_ARGS__                                                                                                                \
    }                                                                                                                          \
    namespace avx2 {                                                                                                           \
    __VA_ARGS__                                                                                                                \
    }                                                                                                                          \
    namespace avx512 {                                                                                                         \
    __VA_ARGS__                                                                                                                \
    }
#else
#define RINGLET_DISPATCH(function, ...) ::ringlet::baseline::function(__VA_ARGS__)
#define RINGLET_DECLARE(...)                                                                                                   \
    namespace baseline {                                                                                                       \
    __VA_ARGS__                                                                                                                \
    }
#endif
