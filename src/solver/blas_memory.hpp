// The working memory of BLAS.
#pragma once

namespace plica {

/// Lets BLAS take its working memory now. Where there is not enough, OpenBLAS (0.3) would otherwise wait for it without
/// end in the middle of a factorisation; here it is std::bad_alloc.
void reserve_blas_memory();

}  // namespace plica
