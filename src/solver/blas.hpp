// How plica calls BLAS: on one thread, with memory that is there.
#pragma once

namespace plica {

/// To be called before BLAS is. OpenBLAS, where a variant with threads is installed, is given one thread: sums would
/// depend on their number. And its working memory is taken now: where there is not enough, OpenBLAS (0.3) would
/// otherwise wait for it without end in the middle of a factorisation; here it is std::bad_alloc.
void prepare_blas();

}  // namespace plica
