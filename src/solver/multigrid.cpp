// For now a factor of all of the matrix.
#include "solver/block_cholesky.hpp"
#include "solver/preconditioner.hpp"

namespace plica {

std::unique_ptr<Preconditioner> make_multigrid(const BlockPattern& pattern) {
  return std::make_unique<BlockCholesky>(pattern);
}

}  // namespace plica
