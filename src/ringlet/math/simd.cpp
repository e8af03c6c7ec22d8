#include "ringlet/math/simd.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace ringlet {
namespace {

Simd widest() {
#ifdef RINGLET_SIMD_X86
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw"))
        return Simd::avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Simd::avx2;
#endif
    return Simd::baseline;
}

Simd chosen() {
    const char *asked = std::getenv("RINGLET_SIMD");
    if (asked == nullptr) return widest();
    const std::string_view name = asked;
    if (name == "baseline") return Simd::baseline;
    if (name == "avx2") return std::min(Simd::avx2, widest());
    return widest();
}

} // namespace

Simd simd() {
    static const Simd set = chosen();
    return set;
}

const char *simd_name(Simd set) {
    switch (set) {
    case Simd::avx512: return "avx512";
    case Simd::avx2: return "avx2";
    default: return "baseline";
    }
}

} // namespace ringlet
