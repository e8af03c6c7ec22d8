#include "ringlet/strand/coupled_strands.h"

#include <algorithm>

namespace ringlet {

CoupledStrands::CoupledStrands(const StrandModel &model, View<Vec3> positions)
    : model_(model), lanes_(RINGLET_DISPATCH(strand_lanes)), order_(order_by_length_and_position(model, positions)),
      place_(model.strand_count()) {
    const int strands = model.strand_count();
    for (int i = 0; i < strands; ++i) place_[order_[i]] = i;
    for (int first = 0; first < strands; first += lanes_)
        groups_.push_back({order_.data() + first, std::min(lanes_, strands - first)});
    systems_.resize(groups_.size());
}

void CoupledStrands::begin(const StrandArrays &arrays, const StrandStep &step) {
    const auto vertices = [&](int group) {
        const int longest = groups_[group].strands[0];
        return model_.offsets[longest + 1] - model_.offsets[longest];
    };
    if (memory_.empty() || memory_bytes_[0] != RINGLET_DISPATCH(strand_group_bytes, step, vertices(0))) {
        memory_.clear();
        memory_bytes_.clear();
        for (int g = 0; g < group_count(); ++g) {
            memory_bytes_.push_back(RINGLET_DISPATCH(strand_group_bytes, step, vertices(g)));
            memory_.emplace_back(memory_bytes_.back());
        }
    }
#pragma omp parallel for schedule(dynamic)
    for (int g = 0; g < group_count(); ++g)
        systems_[g] = RINGLET_DISPATCH(begin_strand_group, arrays, step, groups_[g], memory_[g].get());

    if (systems_.empty() || systems_[0].dofs() == freedoms_) return;
    freedoms_ = systems_[0].dofs();
    begin_.assign(1, 0);
    slot_.assign(model_.vertex_count(), 0);
    for (int g = 0; g < group_count(); ++g) {
        for (int lane = 0; lane < groups_[g].count; ++lane) {
            const int strand = groups_[g].strands[lane], first = model_.offsets[strand];
            for (int v = first; v < model_.offsets[strand + 1]; ++v)
                slot_[v] = begin_.back() + size_t(freedoms_) * (v - first) * lanes_ + lane;
        }
        begin_.push_back(begin_.back() + (size_t(freedoms_) * systems_[g].vertices + systems_[g].padding) * lanes_);
    }
    size_ = begin_.back();
}

void CoupledStrands::end(const AlignedVector &x, const StrandEffort &effort, std::vector<StrandReport> &reports) {
#pragma omp parallel for schedule(dynamic)
    for (int g = 0; g < group_count(); ++g) {
        StrandReport of_group[most_lanes];
        RINGLET_DISPATCH(end_strand_group, memory_[g].get(), x.data() + begin_[g], effort, of_group);
        for (int lane = 0; lane < groups_[g].count; ++lane) reports[groups_[g].strands[lane]] = of_group[lane];
    }
}

void CoupledStrands::energies(int group, const AlignedVector &x, double *of_lanes) const {
    RINGLET_DISPATCH(strand_group_energies, memory_[group].get(), x.data() + begin_[group], of_lanes);
}

void CoupledStrands::evaluate(int group, const AlignedVector &x, double *energies) const {
    RINGLET_DISPATCH(evaluate_strand_group, memory_[group].get(), x.data() + begin_[group], energies);
}

void CoupledStrands::assemble(int group, const AlignedVector &x) const {
    RINGLET_DISPATCH(assemble_strand_group, memory_[group].get(), x.data() + begin_[group]);
}

void CoupledStrands::factor(int group) const { RINGLET_DISPATCH(factor_strand_group, memory_[group].get()); }

void CoupledStrands::solve(int group, double *b) const { RINGLET_DISPATCH(solve_strand_group, memory_[group].get(), b); }

void CoupledStrands::worth_going(int group, const AlignedVector &x, const AlignedVector &direction, double *of_lanes) const {
    RINGLET_DISPATCH(strand_group_max_step, memory_[group].get(), x.data() + begin_[group], direction.data() + begin_[group],
                     of_lanes);
}

void CoupledStrands::turn(int group, const AlignedVector &x, const AlignedVector &direction, AlignedVector &to) const {
    RINGLET_DISPATCH(strand_group_curved_end, memory_[group].get(), x.data() + begin_[group], direction.data() + begin_[group],
                     to.data() + begin_[group]);
}

void CoupledStrands::add_block(int strand, int a, int b, const Mat3 &block) const {
    if (a < b) return;
    const StrandGroupSystem &system = systems_[group_of(strand)];
    const int first = model_.offsets[strand], row = system.dofs() * (a - first), column = system.dofs() * (b - first);
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
            const int below = row + r - column - c;
            if (below >= 0) system.matrix[(system.layout.begin(column + c) + below) * lanes_ + lane_of(strand)] += block(r, c);
        }
}

} // namespace ringlet
