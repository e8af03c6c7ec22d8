// strands kernel, being written
namespace ringlet::RINGLET_SIMD {}
