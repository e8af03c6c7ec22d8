#include "ringlet/solver/block_set.h"

#include <algorithm>

namespace ringlet {

BlockSet::BlockSet(std::vector<Block *> blocks, const VertexTable &table)
    : table_(table), blocks_(std::move(blocks)), place_(table.objects), begin_(count() + 1, 0) {
    for (int b = 0; b < count(); ++b) {
        (blocks_[b]->is_parallel() ? large_ : small_).push_back(b);
        for (size_t lane = 0; lane < blocks_[b]->objects().size(); ++lane)
            place_[blocks_[b]->objects()[lane].number] = {b, int(lane)};
    }
    activate_all();
}

void BlockSet::begin_step(const BlockStep &step) {
    activate_all();
    for_active([&](int b) { blocks_[b]->begin_step(step); });
    lay_out();
}

void BlockSet::lay_out() {
    std::vector<size_t> begin(1, 0);
    for (const Block *block : blocks_) begin.push_back(begin.back() + block->size());
    if (begin == begin_ && !slots_.empty()) return;
    begin_ = std::move(begin);
    slots_.resize(table_.dynamic_vertices);
    for (int b = 0; b < count(); ++b) {
        const Block &block = *blocks_[b];
        for (size_t lane = 0; lane < block.objects().size(); ++lane)
            for (int v = block.objects()[lane].first; v < block.objects()[lane].end; ++v) {
                const size_t row = size_t(block.dofs()) * (v - block.objects()[lane].first);
                slots_[v] = {uint32_t(begin_[b] + row * block.lanes() + lane), uint32_t(block.lanes())};
            }
    }
}

bool BlockSet::all_exact() const {
    return std::all_of(blocks_.begin(), blocks_.end(), [](const Block *block) { return block->is_exact(); });
}

void BlockSet::activate(std::vector<unsigned char> objects) {
    active_objects_ = std::move(objects);
    active_ = blocks_with(active_objects_);
}

std::vector<unsigned char> BlockSet::blocks_with(const std::vector<unsigned char> &objects) const {
    std::vector<unsigned char> blocks(count(), 0);
    for (size_t object = 0; object < objects.size(); ++object)
        if (objects[object]) blocks[block_of(int(object))] = 1;
    return blocks;
}

void BlockSet::gather(const AlignedVector &x, std::vector<Vec3> &positions) const {
    parallel_for(table_.dynamic_vertices, [&](int v) { positions[v] = position(x, v); });
}

void BlockSet::scatter(View<Vec3> positions, AlignedVector &x) const {
    parallel_for(table_.dynamic_vertices, [&](int v) {
        for (int k = 0; k < 3; ++k) x[slots_[v].first + k * slots_[v].stride] = positions[v][k];
    });
}

void BlockSet::to_lanes(int block, const std::vector<double> &of_objects, double *of_lanes) const {
    const std::vector<BlockObject> &objects = blocks_[block]->objects();
    for (size_t lane = 0; lane < objects.size(); ++lane) of_lanes[lane] = of_objects[objects[lane].number];
}

void BlockSet::from_lanes(int block, const double *of_lanes, std::vector<double> &of_objects) const {
    const std::vector<BlockObject> &objects = blocks_[block]->objects();
    for (size_t lane = 0; lane < objects.size(); ++lane) of_objects[objects[lane].number] = of_lanes[lane];
}

} // namespace ringlet
