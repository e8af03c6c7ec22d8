// Order in which strands fill the lanes of the kernels, and memory for them.
#pragma once

#include "ringlet/strand/model.h"

#include <new>
#include <utility>
#include <vector>

namespace ringlet {

inline constexpr int most_lanes = 8; // of any instruction set

// Memory for the kernels, aligned for any instruction set.
class Workspace {
public:
    explicit Workspace(size_t bytes) : memory_(::operator new(bytes, alignment)) {}
    ~Workspace() { ::operator delete(memory_, alignment); }
    Workspace(Workspace &&other) noexcept : memory_(std::exchange(other.memory_, nullptr)) {}
    Workspace &operator=(Workspace &&other) noexcept {
        std::swap(memory_, other.memory_);
        return *this;
    }
    void *get() const { return memory_; }

private:
    static constexpr std::align_val_t alignment{64};
    void *memory_;
};

// Longest first, so that strands of a group have similar lengths and few rows lie behind a tip. The order is fixed: the result
// of a strand depends neither on its group nor on the number of threads.
std::vector<int> order_by_length(const StrandModel &model);

// The same; of equal length, near strands follow one another, so that strands in contact share groups.
std::vector<int> order_by_length_and_position(const StrandModel &model, View<Vec3> positions);

} // namespace ringlet
