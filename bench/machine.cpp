// What one thread of this machine can do at most: fused multiply-adds, and bytes to and from its caches and its memory.
//   g++ -O3 -march=native -mprefer-vector-width=512 bench/machine.cpp -o machine && ./machine
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

typedef double Pack __attribute__((vector_size(64)));

static double seconds() { // of this thread alone, whatever else the machine does
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// The best of five: a · m + c in as many independent chains as hide the latency.
static double multiply_adds() {
    constexpr int chains = 12;
    const long count = 20'000'000;
    double best = 0, sum = 0;
    for (int attempt = 0; attempt < 5; ++attempt) {
        Pack a[chains];
        for (int k = 0; k < chains; ++k) a[k] = Pack{} + double(k);
        const double start = seconds();
        for (long i = 0; i < count; ++i) {
#pragma GCC unroll 12
            for (int k = 0; k < chains; ++k) a[k] = a[k] * 0.999 + 1e-3;
            asm volatile("" ::: "memory");
        }
        best = std::max(best, double(count) * chains * 16 / (seconds() - start));
        for (int k = 0; k < chains; ++k) sum += a[k][0];
    }
    return sum > 0 ? best : 0;
}

// z = x + 3 y over three arrays of n numbers: 24 bytes each time.
static double triad(size_t n) {
    std::vector<double> x(n, 1.0), y(n, 2.0), z(n, 0.0);
    const size_t repeats = std::max<size_t>(3, (size_t(1) << 29) / n);
    double best = 0;
    for (int attempt = 0; attempt < 3; ++attempt) {
        const double start = seconds();
        for (size_t k = 0; k < repeats; ++k) {
            double *__restrict to = z.data();
            const double *__restrict a = x.data(), *__restrict b = y.data();
            for (size_t i = 0; i < n; ++i) to[i] = a[i] + 3.0 * b[i];
            asm volatile("" ::"r"(to) : "memory");
        }
        best = std::max(best, 24.0 * double(n) * double(repeats) / (seconds() - start));
    }
    return best;
}

int main() {
    std::printf("multiply-adds        %6.1f GFlop/s\n", 1e-9 * multiply_adds());
    std::printf("triad of   0.8 MB    %6.1f GB/s\n", 1e-9 * triad(size_t(1) << 15));
    std::printf("triad of 805   MB    %6.1f GB/s\n", 1e-9 * triad(size_t(1) << 25));
}
