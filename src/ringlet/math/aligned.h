// Memory and vectors of doubles aligned for the SIMD kernels of any instruction set.
#pragma once

#include <algorithm>
#include <cstddef>
#include <new>
#include <utility>

namespace ringlet {

class AlignedMemory {
public:
    explicit AlignedMemory(size_t bytes = 0) : memory_(::operator new(bytes, alignment)) {}
    ~AlignedMemory() { ::operator delete(memory_, alignment); }
    AlignedMemory(AlignedMemory &&other) noexcept : memory_(std::exchange(other.memory_, nullptr)) {}
    AlignedMemory &operator=(AlignedMemory &&other) noexcept {
        std::swap(memory_, other.memory_);
        return *this;
    }
    void *get() const { return memory_; }

private:
    static constexpr std::align_val_t alignment{64};
    void *memory_;
};

class AlignedVector {
public:
    explicit AlignedVector(size_t size = 0) : memory_(bytes(size)), size_(size) { fill(0.0); }
    double *data() { return static_cast<double *>(memory_.get()); }
    const double *data() const { return static_cast<const double *>(memory_.get()); }
    double &operator[](size_t i) { return data()[i]; }
    double operator[](size_t i) const { return data()[i]; }
    size_t size() const { return size_; }
    void fill(double value) { std::fill(data(), data() + size_, value); }

    static AlignedVector unset(size_t size) { return {AlignedMemory(bytes(size)), size}; } // to be written wholly

private:
    AlignedVector(AlignedMemory memory, size_t size) : memory_(std::move(memory)), size_(size) {}
    static size_t bytes(size_t size) { return size * sizeof(double) + 64; } // kernels may read behind the end

    AlignedMemory memory_;
    size_t size_;
};

} // namespace ringlet
