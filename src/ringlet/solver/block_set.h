// The blocks of a scene, and their vectors of unknowns one behind the other.
#pragma once

#include "ringlet/linear/lane_vectors.h"
#include "ringlet/math/aligned.h"
#include "ringlet/math/parallel.h"
#include "ringlet/solver/block.h"
#include "ringlet/solver/vertex_table.h"

#include <memory>
#include <vector>

namespace ringlet {

class BlockSet {
public:
    BlockSet(std::vector<Block *> blocks, const VertexTable &table);

    // Opens a step of all blocks, all objects active, and lays out their vectors.
    void begin_step(const BlockStep &step);

    int count() const { return int(blocks_.size()); }
    Block &operator[](int block) const { return *blocks_[block]; }
    int objects() const { return int(place_.size()); }
    int block_of(int object) const { return place_[object].block; }
    Block &of_object(int object) const { return *blocks_[place_[object].block]; }
    int lane_of(int object) const { return place_[object].lane; }
    bool all_exact() const;

    // Objects that are not active stay where they are. A block is active where one of its objects is.
    void activate(std::vector<unsigned char> objects);
    void activate_all() { activate(std::vector<unsigned char>(objects(), 1)); }
    bool is_active(int object) const { return active_objects_[object] != 0; }
    const std::vector<unsigned char> &active_objects() const { return active_objects_; }

    // The blocks that one of the marked objects is in.
    std::vector<unsigned char> blocks_with(const std::vector<unsigned char> &objects) const;

    // Calls work(block) for the active ones: the small in parallel, forwards or backwards, then those that are parallel inside.
    template <class Work> void for_active(const Work &work, bool backwards = false, LoopSite site = LoopSite::here()) const {
        const int small = int(small_.size());
        parallel_chunks(
            small, 1,
            [&](int k) {
                if (const int b = small_[backwards ? small - 1 - k : k]; active_[b]) work(b);
            },
            site);
        for (const int b : large_)
            if (active_[b]) work(b);
    }

    // Calls work(object) for those of the active blocks, in parallel.
    template <class Work> void for_active_objects(const Work &work, LoopSite site = LoopSite::here()) const {
        for_active(
            [&](int b) {
                for (const BlockObject &object : blocks_[b]->objects()) work(object);
            },
            false, site);
    }

    // Vectors of all unknowns.
    size_t size() const { return begin_.back(); } // in doubles
    size_t begin(int block) const { return begin_[block]; }
    size_t end(int block) const { return begin_[block + 1]; }
    double *of(int block, AlignedVector &x) const { return x.data() + begin_[block]; }
    const double *of(int block, const AlignedVector &x) const { return x.data() + begin_[block]; }

    // Coordinate k of a dynamic vertex stands at first + k · stride.
    struct Slot {
        uint32_t first, stride;
    };
    Slot slot(int vertex) const { return slots_[vertex]; }
    int dofs(int vertex) const { return of_object(table_.mesh.object[vertex]).dofs(); }
    Vec3 position(const AlignedVector &x, int vertex) const {
        const auto [first, stride] = slots_[vertex];
        return {x[first], x[first + stride], x[first + 2 * stride]};
    }
    void gather(const AlignedVector &x, std::vector<Vec3> &positions) const; // of dynamic vertices
    void scatter(View<Vec3> positions, AlignedVector &x) const;

    // Numbers of a block's objects, a lane each.
    void to_lanes(int block, const std::vector<double> &of_objects, double *of_lanes) const;
    void from_lanes(int block, const double *of_lanes, std::vector<double> &of_objects) const;

    // Calls work(object, first entry, stride, count) for the unknowns of each of a block's objects.
    template <class Work> void for_objects(int block, const Work &work) const {
        const Block &of = *blocks_[block];
        for (size_t lane = 0; lane < of.objects().size(); ++lane)
            work(of.objects()[lane].number, begin_[block] + lane, size_t(of.lanes()), size_t(of.rows()));
    }

private:
    void lay_out();

    const VertexTable &table_;
    std::vector<Block *> blocks_;
    std::vector<int> small_, large_;
    std::vector<unsigned char> active_, active_objects_; // per block, per object
    struct Place {
        int block, lane;
    };
    std::vector<Place> place_; // of each object
    std::vector<size_t> begin_;
    std::vector<Slot> slots_;
};

} // namespace ringlet
