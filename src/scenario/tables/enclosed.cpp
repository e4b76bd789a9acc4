// [enclosed.NAME]: the volume inside the sheet, fixed or compressible.
#include "mechanics/constraints/enclosed_volume.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_enclosed {

void check_enclosed(Scenario& scenario, Input& input) {
  bool is_kept = false;
  for (auto& [name, it] : scenario.enclosed) {
    const std::string table = "enclosed." + name, key = table + ".bulk_modulus_Pa";
    if (!input.sound(table) || !input.sound(table + ".volume") || !input.sound("embryo.shape")) continue;
    const EnclosedState state = meaning_of(words::enclosed_states, it.volume);
    if (is_patch(shape_of(scenario.embryo)))
      input.report(table, fmt::format("a {} encloses no volume", scenario.embryo.shape),
                   "remove the table, or set embryo.shape to \"pill\" or \"sphere\"");
    if (state == EnclosedState::compliant && !it.bulk_modulus_Pa && input.sound(key))
      input.report(key, "is missing", "set bulk_modulus_Pa to a number > 0");
    if (state != EnclosedState::compliant)
      drop(key, it.bulk_modulus_Pa, {}, table + ".volume", fmt::format("is not used with volume \"{}\"", it.volume),
           "remove bulk_modulus_Pa, or set volume to \"compliant\"", input);
    if (state != EnclosedState::free && std::exchange(is_kept, true))
      input.report(table + ".surface", "another table already constrains this volume", "remove one of the two tables");
    // With cell volumes, enclosed volume and shell volume all fixed, cells can only slide along the shell.
    if (state == EnclosedState::held && scenario.vitelline.enabled && scenario.vitelline.gap_um == 0 &&
        method_of(scenario.volume) == VolumeMethod::coupled && input.sound("vitelline.gap_um"))
      input.report(
          table + ".volume",
          "no cell can leave the vitelline membrane, since cell and enclosed volumes are fixed and the gap is 0",
          "set vitelline.gap_um, for example to 0.5, or volume to \"compliant\"");
  }
}

// Checks that the basal surface encloses a volume; the end planes of a slice count as closed.
void check_encloses_yolk(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  if (!scenario.enclosed.empty() && !EnclosedVolume::is_closed(tissue))
    errors.push_back(diagnostic_at(scenario, "enclosed." + scenario.enclosed.begin()->first,
                                   "the basal surface of this mesh is open", "remove [enclosed.NAME]"));
}

void build(const Scenario& scenario, const Origin&, Model& model) {
  for (const auto& [name, input] : scenario.enclosed) {
    const EnclosedState state = meaning_of(words::enclosed_states, input.volume);
    if (state == EnclosedState::held) model.constraints.push_back(std::make_unique<EnclosedVolume>(model.tissue));
    if (state == EnclosedState::compliant) {
      model.laws.push_back(std::make_unique<ElasticVolume>(model.tissue, *input.bulk_modulus_Pa * units::pascal));
      model.laws.back()->set_label("enclosed." + name);
    }
  }
}

}  // namespace of_enclosed

ScenarioTable enclosed_table() {
  using namespace of_enclosed;
  using N = EnclosedInput;
  ScenarioTable info{"enclosed.*", "Volume enclosed by the cell sheet, such as the yolk.", "Surroundings"};
  const auto row = key_rows(info, &Scenario::enclosed);
  info.rows = {
      row("surface", &N::surface, one_of({"basal"}),
          "Closed surface around the volume: the basal surface of the cells."),
      row("volume", &N::volume, one_of(words::enclosed_states),
          "`held`: conserved, with a Lagrange multiplier as pressure. `compliant`: by `bulk_modulus_Pa`. `free`: "
          "unconstrained."),
      row("bulk_modulus_Pa", &N::bulk_modulus_Pa, positive,
          "Pressure per relative volume loss (Pa); 50 000 conserves the yolk of a furrow to about 0.1 %."),
  };
  info.rules = check_enclosed;
  info.check = check_encloses_yolk;
  info.build = build;
  return info;
}

}  // namespace plica
