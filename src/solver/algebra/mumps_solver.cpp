#include <dmumps_c.h>

#include <mutex>
#include <stdexcept>
#include <string>

#include "solver/algebra/blas.hpp"
#include "solver/algebra/linear_solver.hpp"

namespace plica {
namespace {

// Numbers of MUMPS's user guide: jobs, and places in its control arrays (1-based there).
constexpr int job_initialise = -1, job_end = -2, job_analyse = 1, job_factorise = 2, job_solve = 3;
constexpr int use_default_communicator = -987654;

// MUMPS keeps data beside the structures that it is given, and is not made to be called twice at once.
std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
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

  void analyse(const SparsePattern& lower) override {
    // Fortran counts from 1.
    order_ =
        elimination_order(lower);  // not that of Scotch, with which Debian's MUMPS comes: another from call to call
    for (int& place : order_) ++place;
    rows_.clear();
    columns_.clear();
    for (int row = 0; row < lower.count(); ++row)
      for (const int column : lower.of(row)) {
        rows_.push_back(row + 1);
        columns_.push_back(column + 1);
      }
    id_.n = lower.count();
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
    const std::lock_guard lock(one_at_a_time());
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
