#include "ringlet/strand/block.h"

#include "ringlet/linear/lane_vectors.h"
#include "ringlet/strand/lane_groups.h"
#include "ringlet/strand/settings.h"

#include <algorithm>
#include <numeric>

namespace ringlet {
namespace {

void *scratch_of_thread(size_t bytes) {
    thread_local AlignedMemory memory;
    thread_local size_t size = 0;
    if (size < bytes) memory = AlignedMemory(size = bytes);
    return memory.get();
}

} // namespace

StrandBlock::StrandBlock(const StrandModel &model, StrandState &state, std::vector<int> strands)
    : model_(model), state_(state), strands_(std::move(strands)), reports_(strands_.size()) {
    lanes_ = RINGLET_DISPATCH(strand_lanes);
    for (const int s : strands_) {
        const int first = model.offsets[s], end = model.offsets[s + 1];
        objects_.push_back({s, first, end});
        const double *length = model.rest_length.data();
        mean_edge_.push_back(std::accumulate(length + first, length + end - 1, 0.0) / (end - first - 1));
    }
}

int StrandBlock::strand_of(int vertex) const { // by lane
    for (size_t lane = 0; lane + 1 < objects_.size(); ++lane)
        if (objects_[lane].first <= vertex && vertex < objects_[lane].end) return int(lane);
    return int(objects_.size()) - 1;
}

size_t StrandBlock::slot(int vertex) const {
    const int lane = strand_of(vertex);
    return size_t(dofs_) * (vertex - objects_[lane].first) * lanes_ + lane;
}

void StrandBlock::begin_step(const BlockStep &step) {
    step_.dt = step.dt;
    std::copy(step.gravity.begin(), step.gravity.end(), step_.gravity);
    std::copy(step.wind.begin(), step.wind.end(), step_.wind);
    arrays_ = arrays_of(model_, state_, step.targets, step.forces);
    const size_t bytes = RINGLET_DISPATCH(phased_step_bytes, step_, objects_[0].end - objects_[0].first);
    if (bytes != memory_bytes_) memory_ = AlignedMemory(memory_bytes_ = bytes);
    const StrandGroup group{strands_.data(), int(strands_.size())};
    scratch_bytes_ = RINGLET_DISPATCH(phased_scratch_bytes, step_, objects_[0].end - objects_[0].first);
    phases_ = RINGLET_DISPATCH(make_phased_step, arrays_, step_, group, memory_.get(), scratch_of_thread(scratch_bytes_));
    system_ = phases_->begin();
    dofs_ = system_.dofs();
    rows_ = dofs_ * system_.vertices;
    size_ = (size_t(rows_) + system_.padding) * lanes_;
}

void StrandBlock::initial_guess(double *x) const { std::copy_n(system_.x, unknowns(), x); }

PhasedStep &StrandBlock::phases() const {
    phases_->use(scratch_of_thread(scratch_bytes_));
    return *phases_;
}

void StrandBlock::energies(const double *x, double *of_lanes) { phases().energy(x, of_lanes); }
void StrandBlock::assemble(const double *x, double *of_lanes) { phases().assemble(x, of_lanes); }
void StrandBlock::factor() { phases_->factor(); }
void StrandBlock::solve(double *b) const { phases_->solve(b); }

void StrandBlock::max_step(const double *x, const double *direction, double *of_lanes) const {
    phases_->max_step(x, direction, of_lanes);
}

void StrandBlock::bend(const double *x, const double *straight, double *bend) const {
    phases_->curved_end(x, straight, bend);
    for (size_t i = 0; i < unknowns(); ++i) bend[i] -= x[i] + straight[i];
}

void StrandBlock::add_gradient(int vertex, const Vec3 &gradient) {
    const size_t at = slot(vertex);
    for (int i = 0; i < 3; ++i) system_.gradient[at + i * lanes_] += gradient[i];
}

void StrandBlock::add_block(int vertex, int other, const Mat3 &block) {
    const int lane = strand_of(vertex), first = objects_[lane].first;
    const int below = dofs_ * (vertex - other);
    size_t diagonal = system_.layout.begin(dofs_ * (other - first));
    for (int c = 0; c < 3; ++c) {
        for (int r = below == 0 ? c : 0; r < 3; ++r) // only the lower half is stored
            system_.matrix[(diagonal + below + r - c) * lanes_ + lane] += block(r, c);
        diagonal += system_.layout.rows(c);
    }
}

void StrandBlock::add_to(MatrixAssembly &matrix) const {
    const int reach = (system_.layout.band - 1) / dofs_, stride = matrix.block();
    for (size_t lane = 0; lane < objects_.size(); ++lane) {
        const int first = objects_[lane].first, count = objects_[lane].end - first;
        for (int b = 0; b < count; ++b)
            for (int a = b; a < std::min(count, b + reach + 1); ++a) {
                double *block = matrix.add_block(first + a, first + b);
                for (int r = 0; r < dofs_; ++r)
                    for (int c = 0; c < dofs_; ++c) {
                        const int column = b * dofs_ + (a == b ? std::min(r, c) : c);
                        const int below = a * dofs_ + (a == b ? std::max(r, c) : r) - column;
                        if (below < system_.layout.rows(column))
                            block[r * stride + c] = system_.matrix[(system_.layout.begin(column) + below) * lanes_ + lane];
                    }
            }
    }
}

// Inertia, bending about a neighbour, and a tenth of the stretch: what a vertex resists by before the rest of the strand does.
void StrandBlock::contact_stiffness(double dt, std::vector<double> &of_vertices) const {
    for (const BlockObject &strand : objects_)
        for (int v = strand.first; v < strand.end; ++v) {
            if (model_.held[v]) continue;
            const double length = std::max(model_.rest_length[v], model_.rest_length[v - 1]);
            const double bend = std::max(model_.bend_stiffness[v], model_.bend_stiffness[v - 1]) / (length * length);
            of_vertices[v] =
                model_.mass[v] / (dt * dt) + bend + strand_settings::contact_stretch * model_.stretch_stiffness[v - 1];
        }
}

bool StrandBlock::is_stretched(int lane, View<Vec3> positions) const {
    for (int v = objects_[lane].first; v + 1 < objects_[lane].end; ++v)
        if ((positions[v + 1] - positions[v]).norm() > (1.0 + strand_settings::refined_strain) * model_.rest_length[v])
            return true;
    return false;
}

double StrandBlock::settled_distance(int lane) const { return strand_settings::settled_fraction * mean_edge_[lane]; }

bool StrandBlock::commit(const double *x, double, const SolverEffort &effort) {
    const StrandEffort of_strands{effort.iterations, effort.cuts, effort.residual};
    StrandReport reports[max_lanes];
    phases().end(x, of_strands, reports);
    std::copy_n(reports, reports_.size(), reports_.begin());
    for (size_t lane = 0; lane < reports_.size(); ++lane) reports_[lane].stalled = effort.stalled[objects_[lane].number];
    return std::none_of(reports_.begin(), reports_.end(), [](const StrandReport &report) { return report.nan > 0; });
}

std::vector<std::unique_ptr<StrandBlock>> make_strand_blocks(const StrandModel &model, StrandState &state) {
    const std::vector<int> order = order_by_length_and_position(model, state.positions);
    const size_t lanes = RINGLET_DISPATCH(strand_lanes);
    std::vector<std::unique_ptr<StrandBlock>> blocks;
    for (size_t first = 0; first < order.size(); first += lanes) {
        const auto begin = order.begin() + first, end = order.begin() + std::min(first + lanes, order.size());
        blocks.push_back(std::make_unique<StrandBlock>(model, state, std::vector<int>(begin, end)));
    }
    return blocks;
}

} // namespace ringlet
