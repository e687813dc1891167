#pragma once

namespace maximin::deep {

/// Prepares the process for small networks: one thread for LibTorch and for its linear algebra (more than that spend
/// their time on waiting for each other; run seeds in processes of their own instead), and an allocator that keeps its
/// memory between steps instead of handing it back and faulting it in again. Call it first.
void prepare_runtime();

}  // namespace maximin::deep
