#include <dmumps_c.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "solver/linear_solver.hpp"

namespace plica {
namespace {

// Numbers of MUMPS's user guide: jobs, and places in its control arrays (1-based there).
constexpr int job_initialise = -1, job_end = -2, job_analyse = 1, job_factorise = 2, job_solve = 3;
constexpr int use_default_communicator = -987654;

class MumpsSolver final : public LinearSolver {
 public:
  MumpsSolver() {
    id_.sym = 2;  // symmetric, indefinite
    id_.par = 1;
    id_.comm_fortran = use_default_communicator;
    call(job_initialise);
    for (const int stream : {1, 2, 3, 4}) icntl(stream) = stream == 4 ? 0 : -1;  // silent
    icntl(7) = 5;    // nested dissection by METIS; PORD is faster here, but ends the process on some small graphs
    icntl(8) = 0;    // no scaling: it costs 3 % of a factorisation, and the pivots are as good without
    icntl(14) = 60;  // per cent of room for delayed pivots
  }
  ~MumpsSolver() override { call(job_end); }
  MumpsSolver(const MumpsSolver&) = delete;
  MumpsSolver& operator=(const MumpsSolver&) = delete;

  void analyse(const SymmetricPattern& pattern) override {
    rows_ = pattern.rows;
    columns_ = pattern.columns;
    for (int& row : rows_) ++row;
    for (int& column : columns_) ++column;
    id_.n = pattern.size;
    id_.nnz = static_cast<MUMPS_INT8>(rows_.size());
    id_.irn = rows_.data();
    id_.jcn = columns_.data();
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
    dmumps_c(&id_);
  }
  int& icntl(int number) { return id_.icntl[number - 1]; }

  // MUMPS keeps its factor and its scratch in one structure, so that solving with a factor writes to it.
  mutable DMUMPS_STRUC_C id_{};
  std::vector<int> rows_, columns_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver() { return std::make_unique<MumpsSolver>(); }

}  // namespace plica
