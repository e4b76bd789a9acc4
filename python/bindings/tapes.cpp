#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <set>
#include <tuple>

#include "arrays.hpp"
#include "core/errors.hpp"
#include "errors.hpp"
#include "given_energy.hpp"
#include "simulation.hpp"
#include "simulation/tape.hpp"
#include "thread_count.hpp"

namespace plica::python {
namespace {

using NodeVectors = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

Vectors vectors_of(const NodeVectors& numbers) {
  Vectors vectors;
  for (std::size_t n = 0; n < numbers.shape(0); ++n) vectors.emplace_back(numbers(n, 0), numbers(n, 1), numbers(n, 2));
  return vectors;
}

/// Call work(stop) without the GIL. A signal or failure is raised afterwards.
template <class Work>
auto computed(int threads, const Work& work) {
  Signals signals;
  decltype(work(std::function<bool()>())) result;
  try {
    const nb::gil_scoped_release free;
    const SafeThreadCount count(threads);
    result = work(std::function<bool()>([&] { return signals.have_come(); }));
  } catch (const RecordingFailed& failed) {
    throw GaveUp{failed.what(), failed.cell, failed.time_s};
  }
  signals.rethrow();
  return result;
}

/// Tape with its number of threads; handles Ctrl-C.
class TapeOf {
 public:
  TapeOf(Tape tape, int threads) : tape_(std::move(tape)), threads_(threads) {}

  static std::unique_ptr<TapeOf> record(const CheckedScenario& scenario, int threads, std::vector<double> at_s,
                                        double until_s, const StrengthFactors& strengths, const nb::list& energies) {
    const PartsAddition add = adding_energies(energies);
    return computed(threads, [&](const auto& stop) {
      return std::make_unique<TapeOf>(Tape(scenario.scenario, {std::move(at_s), until_s, strengths, add, stop}),
                                      threads);
    });
  }
  [[nodiscard]] std::unique_ptr<TapeOf> replayed(const CheckedScenario& scenario, const StrengthFactors& strengths,
                                                 const nb::list& energies) const {
    const PartsAddition add = adding_energies(energies);
    return computed(threads_, [&](const auto&) {
      return std::make_unique<TapeOf>(tape_.replayed({scenario.scenario, add}, strengths), threads_);
    });
  }
  /// `more`, `less`: scenario and energies.
  [[nodiscard]] std::shared_ptr<ModelPair> parameter(const std::string& name,
                                                     const std::tuple<const CheckedScenario*, nb::list>& more,
                                                     const std::tuple<const CheckedScenario*, nb::list>& less,
                                                     double difference) const {
    const auto variant_of = [](const auto& given) {
      return Tape::Variant(std::get<0>(given)->scenario, adding_energies(std::get<1>(given)));
    };
    const Tape::Variant of_more = variant_of(more), of_less = variant_of(less);
    return computed(threads_, [&](const auto&) {
      return std::make_shared<ModelPair>(tape_.parameter(name, of_more, of_less, difference));
    });
  }
  [[nodiscard]] nb::tuple gradient(const std::map<std::size_t, NodeVectors>& outcome,
                                   const std::vector<std::shared_ptr<ModelPair>>& parameters, const std::string& law,
                                   double tolerance) const {
    OutcomeGradient by_positions;
    for (const auto& [state, gradient] : outcome) by_positions[state] = vectors_of(gradient);
    RunGradient gradient = computed(threads_, [&](const auto& stop) {
      Tape::Wanted wanted{{}, law, tolerance, stop};
      for (const auto& parameter : parameters) wanted.parameters.push_back(parameter.get());
      return tape_.gradient(by_positions, wanted).value_or(RunGradient());
    });
    return nb::make_tuple(array_of(std::move(gradient.by_parameter)), array_of(std::move(gradient.by_strength)));
  }

  /// One row per outcome.
  [[nodiscard]] nb::object jacobian(const std::vector<std::map<std::size_t, NodeVectors>>& outcomes,
                                    const std::vector<std::shared_ptr<ModelPair>>& parameters, double tolerance) const {
    std::vector<OutcomeGradient> by_positions;
    for (const auto& outcome : outcomes) {
      OutcomeGradient& of_outcome = by_positions.emplace_back();
      for (const auto& [state, gradient] : outcome) of_outcome[state] = vectors_of(gradient);
    }
    const auto rows = computed(threads_, [&](const auto& stop) {
      TangentInput wanted{{}, tolerance, stop};
      for (const auto& parameter : parameters) wanted.parameters.push_back(parameter.get());
      return tape_.jacobian(by_positions, wanted).value_or(std::vector<std::vector<double>>());
    });
    std::vector<double> numbers;
    for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
    return array_of(std::move(numbers));
  }

  /// Return derivatives of positions along a change of strengths: states x nodes x 3.
  [[nodiscard]] nb::list tangent(const StrengthFactors& change, const std::vector<std::size_t>& states,
                                 double tolerance) const {
    const std::vector<Vectors> found = computed(threads_, [&](const auto& stop) {
      return tape_.tangent(change, states, {{}, tolerance, stop}).value_or(std::vector<Vectors>());
    });
    nb::list result;
    for (const Vectors& of_state : found) result.append(array_of(std::span<const Vec3>(of_state)));
    return result;
  }

  [[nodiscard]] const Tape& tape() const { return tape_; }

 private:
  Tape tape_;
  int threads_;
};

}  // namespace

void bind_tapes(nb::module_& module) {
  nb::class_<ModelPair>(module, "Parameter");
  nb::class_<TapeOf>(module, "Tape")
      .def_static("record", &TapeOf::record, nb::arg("scenario"), nb::arg("threads"), nb::arg("at_s"),
                  nb::arg("until_s"), nb::arg("strengths"), nb::arg("energies"))
      .def("replayed", &TapeOf::replayed, nb::arg("scenario"), nb::arg("strengths"), nb::arg("energies"))
      .def("parameter", &TapeOf::parameter, nb::arg("name"), nb::arg("more"), nb::arg("less"), nb::arg("difference"))
      .def("gradient", &TapeOf::gradient, nb::arg("outcome"), nb::arg("parameters"), nb::arg("law"),
           nb::arg("tolerance"))
      .def("jacobian", &TapeOf::jacobian, nb::arg("outcomes"), nb::arg("parameters"), nb::arg("tolerance"))
      .def("tangent", &TapeOf::tangent, nb::arg("change"), nb::arg("states"), nb::arg("tolerance"))
      .def(
          "state_at", [](const TapeOf& self, double time_s) { return self.tape().state_at(time_s); }, nb::arg("time_s"))
      .def(
          "positions",
          [](const TapeOf& self, std::size_t state) {
            return array_of(std::span<const Vec3>(self.tape().positions(state)));
          },
          nb::arg("state"))
      .def(
          "outcome",
          [](const TapeOf& self, const std::string& name, std::size_t state) {
            const SmoothOutcome outcome = self.tape().outcome(name, state);
            return nb::make_tuple(outcome.value, array_of(std::span<const Vec3>(outcome.gradient)));
          },
          nb::arg("name"), nb::arg("state"))
      .def(
          "surface_nodes",
          [](const TapeOf& self, const std::string& side) {
            if (side != "apical" && side != "basal")
              throw UsageError("surface: \"" + side + "\"; give \"apical\", \"basal\" or \"all\"");
            std::set<int> nodes;
            const Tissue& tissue = self.tape().tissue(self.tape().steps());
            for (const Facet& facet : tissue.facets(side == "basal" ? CellSide::basal : CellSide::apical))
              for (const NodeId node : facet.nodes) nodes.insert(node.number());
            return array_of(std::vector<int>(nodes.begin(), nodes.end()));
          },
          nb::arg("side"))
      .def_prop_ro("originals",
                   [](const TapeOf& self) {
                     std::vector<int> originals;
                     for (std::size_t cell = 0; cell < self.tape().tissue().cells.size(); ++cell)
                       originals.push_back(self.tape().mirror().original(CellId(cell)).number());
                     return array_of(originals);
                   })
      .def_prop_ro("cell_count", [](const TapeOf& self) { return self.tape().tissue().cells.size(); })
      .def_prop_ro("changes", [](const TapeOf& self) { return self.tape().changes(); })
      .def_prop_ro("times_s", [](const TapeOf& self) { return array_of(self.tape().times_s()); });
}

}  // namespace plica::python
