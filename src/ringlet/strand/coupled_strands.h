// All strands of a scene in the middle of a step, for a solver that couples them with what they touch.
#pragma once

#include "ringlet/strand/lane_order.h"
#include "ringlet/strand/state.h"

#include <algorithm>
#include <deque>
#include <vector>

namespace ringlet {

// A vector of doubles aligned for the kernels.
class AlignedVector {
public:
    explicit AlignedVector(size_t size = 0) : memory_(size * sizeof(double) + 64), size_(size) { fill(0.0); }
    double *data() { return static_cast<double *>(memory_.get()); }
    const double *data() const { return static_cast<const double *>(memory_.get()); }
    double &operator[](size_t i) { return data()[i]; }
    double operator[](size_t i) const { return data()[i]; }
    size_t size() const { return size_; }
    void fill(double value) { std::fill(data(), data() + size_, value); }

private:
    Workspace memory_;
    size_t size_;
};

// Unknowns stand group by group as the kernels have them: coordinate k of vertex v at slot(v) + k · stride(v).
class CoupledStrands {
public:
    CoupledStrands(const StrandModel &model, View<Vec3> positions);

    // Opens a step. What is given must live until end().
    void begin(const StrandArrays &arrays, const StrandStep &step);
    void end(const AlignedVector &x, const StrandEffort &effort, std::vector<StrandReport> &reports);

    int group_count() const { return int(groups_.size()); }
    size_t size() const { return size_; } // of a vector of all unknowns, in doubles
    size_t slot(int vertex) const { return slot_[vertex]; }
    int stride() const { return lanes_; }
    int group_of(int strand) const { return place_[strand] / lanes_; }
    int lane_of(int strand) const { return place_[strand] % lanes_; }
    size_t group_begin(int group) const { return begin_[group]; }
    size_t group_end(int group) const { return begin_[group + 1]; } // with padding

    const StrandGroupSystem &system(int group) const { return systems_[group]; }
    StrandGroup strands_of(int group) const { return groups_[group]; }
    void energies(int group, const AlignedVector &x, double *of_lanes) const;
    void evaluate(int group, const AlignedVector &x, double *energies_of_lanes) const; // before it is assembled there
    void assemble(int group, const AlignedVector &x) const;
    void factor(int group) const;
    void solve(int group, double *b) const; // in place; b is all that the group has of a vector
    void worth_going(int group, const AlignedVector &x, const AlignedVector &direction, double *of_lanes) const;
    void turn(int group, const AlignedVector &x, const AlignedVector &direction, AlignedVector &to) const;

    // Adds a 3 × 3 block to the matrix: rows of vertex a, columns of vertex b, both of one strand, b = a or a + 1 or the other
    // way round (of a block and its transpose only the lower one is stored).
    void add_block(int strand, int a, int b, const Mat3 &block) const;

private:
    const StrandModel &model_;
    int lanes_, freedoms_ = 0;
    std::vector<int> order_, place_; // strands by length, and where each is in that order
    std::vector<StrandGroup> groups_;
    std::deque<Workspace> memory_;
    std::vector<size_t> memory_bytes_;
    std::vector<StrandGroupSystem> systems_;
    std::vector<size_t> begin_, slot_;
    size_t size_ = 0;
};

} // namespace ringlet
