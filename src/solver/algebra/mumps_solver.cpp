#include <dmumps_c.h>
#include <metis.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <string>

#include "solver/algebra/blas.hpp"
#include "solver/algebra/linear_solver.hpp"

namespace plica {
namespace {

// Numbers of MUMPS's user guide: jobs, and places in its control arrays (1-based there).
constexpr int job_initialise = -1, job_end = -2, job_analyse = 1, job_factorise = 2, job_solve = 3;
constexpr int use_default_communicator = -987654;

/// The place of each row in the order of elimination, 1-based: nested dissection by METIS. (Scotch, the orderer of
/// Debian's MUMPS, gives another order from call to call.)
std::vector<int> elimination_order(const SymmetricPattern& pattern) {
  std::vector<idx_t> starts(pattern.size + 1, 0), neighbours;
  for (std::size_t e = 0; e < pattern.rows.size(); ++e)
    if (pattern.rows[e] != pattern.columns[e]) ++starts[pattern.rows[e] + 1], ++starts[pattern.columns[e] + 1];
  for (int i = 0; i < pattern.size; ++i) starts[i + 1] += starts[i];
  neighbours.resize(starts.back());
  std::vector<idx_t> next(starts.begin(), starts.end() - 1);
  for (std::size_t e = 0; e < pattern.rows.size(); ++e) {
    const int row = pattern.rows[e], column = pattern.columns[e];
    if (row == column) continue;
    neighbours[next[row]++] = column;
    neighbours[next[column]++] = row;
  }
  std::vector<int> order(pattern.size);
  std::iota(order.begin(), order.end(), 1);
  if (neighbours.empty()) return order;  // METIS wants an edge
  idx_t size = pattern.size;
  std::array<idx_t, METIS_NOPTIONS> options;
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  std::vector<idx_t> rows(size), places(size);
  if (METIS_NodeND(&size, starts.data(), neighbours.data(), nullptr, options.data(), rows.data(), places.data()) !=
      METIS_OK)
    throw std::runtime_error("METIS could not order the matrix");
  std::transform(places.begin(), places.end(), order.begin(), [](idx_t place) { return static_cast<int>(place) + 1; });
  return order;
}

class MumpsSolver final : public LinearSolver {
 public:
  MumpsSolver() {
    prepare_blas();
    id_.sym = 2;  // symmetric, indefinite
    id_.par = 1;
    id_.comm_fortran = use_default_communicator;
    call(job_initialise);
    for (const int stream : {1, 2, 3, 4}) icntl(stream) = stream == 4 ? 0 : -1;  // silent
    icntl(7) = 1;                                                                // the order is given
    icntl(8) = 0;    // no scaling: it costs 3 % of a factorisation, and the pivots are as good without
    icntl(14) = 60;  // per cent of room for delayed pivots
  }
  ~MumpsSolver() override { call(job_end); }
  MumpsSolver(const MumpsSolver&) = delete;
  MumpsSolver& operator=(const MumpsSolver&) = delete;

  void analyse(const SymmetricPattern& pattern) override {
    order_ = elimination_order(pattern);
    rows_ = pattern.rows;
    columns_ = pattern.columns;
    for (int& row : rows_) ++row;
    for (int& column : columns_) ++column;
    id_.n = pattern.size;
    id_.nnz = static_cast<MUMPS_INT8>(rows_.size());
    id_.irn = rows_.data();
    id_.jcn = columns_.data();
    id_.perm_in = order_.data();
    call(job_analyse);
    if (id_.infog[0] < 0)
      throw std::runtime_error("the linear solver cannot analyse the system (MUMPS error " +
                               std::to_string(id_.infog[0]) + ")");
  }

  bool factorise(std::span<const double> values) override {
    values_.assign(values.begin(), values.end());
    id_.a = values_.data();
    for (int attempt = 0; attempt < 4; ++attempt) {
      call(job_factorise);
      constexpr int work_array_too_small = -9, work_array_too_small_too = -8;
      if (id_.infog[0] != work_array_too_small && id_.infog[0] != work_array_too_small_too) break;
      icntl(14) *= 2;
    }
    return id_.infog[0] >= 0;
  }

  void solve(std::span<double> right_hand_side) const override {
    id_.rhs = right_hand_side.data();
    id_.nrhs = 1;
    call(job_solve);
  }

 private:
  void call(int job) const {
    id_.job = job;
    const BlasUse use;
    dmumps_c(&id_);
  }
  int& icntl(int number) { return id_.icntl[number - 1]; }

  // MUMPS keeps its factor and its scratch in one structure, so that solving with a factor writes to it.
  mutable DMUMPS_STRUC_C id_{};
  std::vector<int> rows_, columns_, order_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver() { return std::make_unique<MumpsSolver>(); }

}  // namespace plica
