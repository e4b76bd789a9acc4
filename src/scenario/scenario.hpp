// Scenario as plain data, in the units of its keys. `load_scenario` (load.hpp) fills it from TOML. Types, ranges,
// defaults and meanings of keys are in tables/.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plica {

struct GivenPrisms;
struct HexahedralMesh;

using Range = std::array<double, 2>;  // low, high

/// Activity time course: linear between the points, constant before the first and after the last; empty: always 1.
struct ProgramInput {
  std::vector<double> time_s;
  std::vector<double> activity;
};

/// Named cell set. Given selectors are intersected; `unite`, `intersect`, `except` name other regions.
struct RegionInput {
  std::string face;                // ventral dorsal left right anterior posterior, or empty
  std::optional<int> cells_along;  // centred strip of the face
  std::optional<int> cells_across;
  std::vector<int> ids;
  std::string array;                                  // cell array of the file: cells where it is not 0, or
  std::optional<double> above, below;                 // above and below these values
  std::optional<Range> angle_deg;                     // of the cell's centre about x, from ventral towards +y
  std::optional<Range> length_percent;                // of the embryo's length, from the anterior end
  std::optional<Range> x_um, y_um, z_um;              // of the reference cell centre
  std::optional<int> rows;                            // about the ventral midline, both sides together
  std::string neighbours_of;                          // region: cells adjacent to it, outside it
  std::optional<int> rings;                           // up to this many lateral faces away; empty: 1
  std::vector<std::string> unite, intersect, except;  // TOML keys: union, intersect, except
};

enum class EmbryoShape { pill, sphere, slice, block, egg, points, sheet, surface, prisms, file };

struct EmbryoInput {
  std::string shape = "pill";  // pill | sphere | slice | block | egg | points | sheet | surface | prisms | file
  double length_um = 460;      // pill, slice, block, egg, sheet: along x
  double diameter_um = 280;    // pill, sphere, slice, egg
  double width_um = 20;        // block, sheet: along y
  double cell_height_um = 40;
  std::array<int, 3> cells = {18, 9, 8};
  std::array<int, 3> elements_per_cell = {1, 1, 1};
  std::vector<std::string> mirror;                  // x, y: symmetry planes; one side is solved
  int cell_count = 6000;                            // egg, sheet
  int seed = 1;                                     // egg, sheet: cell arrangement
  std::optional<double> belly_sag_um, back_sag_um;  // egg: ventral and dorsal bulge
  std::string elements = "diagonals";               // polygons: diagonals | kites
  double least_edge_ratio = 0.3;                    // polygons: relative to the mean; shorter edges are lengthened
  int layers = 1;                                   // polygons: elements from basal to apical
  std::vector<double> curvature_per_um = {0, 0};    // sheet: along x and y; positive as on an embryo
  std::string rim = "free";                         // sheet, surface, prisms: free | held
  std::vector<std::string> periodic;                // sheet: x, y: periodic directions
  std::string cell_height_array;                    // surface: array of heights; empty: cell_height_um
  bool mend = true;                                 // surface, prisms: whether the mesh is repaired
  bool centre = false;                              // from a file: whether its centre is moved to the origin
  std::vector<double> scale = {1, 1, 1};            // from a file
  std::vector<double> rotate_deg = {0, 0, 0};       // from a file: about x, then y, then z
  std::string keep = "all";                         // surface, file: all | largest: pieces that become cells
  std::string label_array;                          // surface: faces of one number are a cell; empty: each face is
  double points_depth_um = 0;                       // points: below the apical surface, before scaling
  std::string file;               // "file": hexahedral mesh read by VTK; "points": table; others: polygons
  std::string apical_array;       // shape = "file": cell array with the face index 0-5 (VTK order) of the apical face;
                                  // empty: the outer surface
  std::string cell_arrays;        // table with one row per cell; its columns become arrays
  std::vector<std::string> axes;  // names of the ends of x, y, z ("low-high", or one word); empty: by the shape
  std::shared_ptr<const HexahedralMesh> mesh;         // replaces the file; set by programs, not in TOML
  std::shared_ptr<const GivenPrisms> prisms;          // likewise
  std::map<std::string, std::vector<double>> arrays;  // cells; besides those of files; set by programs, not in TOML
};

enum class ElasticModel { corotational, shape_memory, neo_hookean };

struct ElasticityInput {
  std::string model = "corotational";  // corotational | shape-memory | neo-hookean
  double young_modulus_Pa = 1000;
  double poisson_ratio = 0.45;
  std::optional<double> attractor_stiffness_nN_per_um;  // shape-memory; empty: derived from the two above
  double attractor_preload_nN = 0;                      // shape-memory
  double attractor_preload_length_um = 0.5;             // shape-memory: distance above which it acts in full
  std::optional<double> corner_barrier_Pa;              // empty: automatic, which validate() replaces
  std::optional<double> relaxation_s;  // neo-hookean; TOML: relaxation_s or relaxation_min; empty: "none"
};

enum class VolumeMethod { coupled, projection, none };

struct VolumeInput {
  std::string method = "coupled";            // coupled | projection | none
  std::string projection_surface = "cells";  // cells | tissue | embryo
  std::string projection_weights = "equal";  // equal | mobility
};

struct VitellineInput {
  bool enabled = true;
  double gap_um = 0;
  double drag_Pa_s_per_um = 0;
};

struct DynamicsInput {
  double surface_drag_Pa_s_per_um = 140;
  double shear_viscosity_Pa_s = 0;
  double density_kg_per_m3 = 0;
};

struct ProfileInput {
  std::string shape;                 // constant | linear | gaussian | plateau | table | array; empty: constant
  std::string axis;                  // across | along | angle; empty: across
  std::string about;                 // region; empty: the one that acts
  std::optional<double> centre_deg;  // axis = "angle": angle of the centre; empty: 0
  std::optional<double> half_width_deg, sigma_deg, full_deg, fade_deg;  // axis = "angle": linear, gaussian, plateau
  std::vector<double> at_um, at_cells, at_deg;                          // table: one of them
  std::vector<double> factor;                                           // table
  std::string array;                                                    // array: cell array of the tissue
  std::optional<double> from, to;                 // array: values at which the factor is edge, and middle
  std::optional<double> half_width_um;            // linear
  std::optional<double> sigma_um, sigma_cells;    // gaussian: one of them
  std::optional<double> full_cells, fade_cells;   // plateau
  std::optional<double> full_length_um, fade_um;  // both or none
  std::optional<double> middle, edge;             // empty: 1, 0
};

struct DelayInput {
  std::optional<double> speed_um_per_s;  // empty: no delay
  std::string axis;                      // along | across; empty: along
  std::string from;                      // middle | ends | low | high; empty: middle
};

struct VariationInput {
  double spread = 0;
  int seed = 1;
  std::string by;  // number | place: cell property that sets the factor; empty: number
};

/// Pulsatile activity of each cell.
struct PulseInput {
  std::optional<double> period_s;  // TOML: period_s or period_min; empty: no pulses
  double amplitude = 1;
  std::string phase;  // random | together; empty: random
  double spread = 0;  // relative, of the cells' periods
  int seed = 1;
};

/// Where, how strongly and when the cells of a table act; base of the tables that act.
struct ActingInput {
  std::string region;
  std::string faces = "apical";  // apical | basal | lateral; TOML: edges, faces or face; elasticity: not used
  ProgramInput program;
  ProfileInput profile;
  DelayInput delay;
  VariationInput variation;
  PulseInput pulse;
};

/// Different elastic properties of a region, or of a layer of its elements.
struct RegionElasticityInput : ActingInput {  // profile: factor on the modulus
  std::optional<Range> height_percent;        // of element centres, basal to apical; empty: all
  std::optional<double> young_modulus_Pa;
  std::optional<double> poisson_ratio;
  std::optional<double> relaxation_s;
};

/// Shape measure (ShapeMeasure) or signal that a cell reads; both empty: none.
struct ActivationInput {
  std::string measure, signal;
  std::string of = "cell";  // cell | neighbours: whose

  [[nodiscard]] bool is_used() const { return !measure.empty() || !signal.empty(); }
};

/// Shape-dependent activation: a threshold on a shape or signal starts the programs of a cell.
struct TriggerInput : ActivationInput {
  std::optional<double> below, above;  // one of them
};

/// A factor on what a table does that follows a shape (of cortices only) or a signal.
struct FollowInput : ActivationInput {
  std::optional<double> from, to;
};

struct ContractionInput : ActingInput {
  std::string border;  // region on the other side of a cable; empty: all edges of the cells
  double stiffness_nN_per_um = 0;
  double along_ratio = 1;
  double across_ratio = 1;
  bool diagonals = false;
  double rest_length_ratio = 0;
  double preload_nN = 0;
  double tension_mN_per_m = 0;
  double damping_nN_s_per_um = 0;
  FollowInput follow;  // signal
};

/// Tension along a direction: lateral faces have a factor by the angle between their normal and an axis, others fibres.
struct DirectionInput {
  std::string axis;   // along | across | long-axis | stretch; empty: none
  std::string array;  // of angles to it, degrees; empty: 0
  double strongest = 1, weakest = 1;
};

/// Fluctuation of the tension of lateral faces.
struct WallNoiseInput {
  double spread = 0;                    // 0: none
  std::optional<double> correlation_s;  // TOML: correlation_s or correlation_min
  int seed = 1;
};

struct CortexInput : ActingInput {
  double tension_mN_per_m = 0;
  double saturation_ratio = 0;
  double stiffness_mN_per_m = 0;
  double compression_ratio = 1;
  double crowding_mN_per_m = 0;
  std::optional<double> relaxation_s;  // TOML: relaxation_s or relaxation_min; empty: "none"
  ProgramInput stiffness_program;
  TriggerInput trigger;
  FollowInput follow;
  DirectionInput direction;
  WallNoiseInput noise;
};

struct SignalSourceInput {
  std::string region;             // empty: none
  std::optional<double> per_min;  // concentration
};

/// Concentration per cell that is made, decays, reacts and diffuses.
struct SignalInput {
  double diffusion_um2_per_min = 0;
  double decay_per_min = 0;
  SignalSourceInput source;
  std::string reaction;                     // per minute; empty: none
  std::map<std::string, double> constants;  // of the reaction
  double initial = 0;
  std::string initial_region = "all";
  std::string initial_array;  // empty: `initial`
  double initial_spread = 0;
  int seed = 1;
};

enum class EnclosedState { held, compliant, free };

struct EnclosedInput {
  std::string surface = "basal";
  std::string volume = "held";            // held | compliant | free
  std::optional<double> bulk_modulus_Pa;  // compliant
};

enum class ContactSurface { none, apical, basal, both };

struct SelfContactInput {
  std::string surface = "none";  // none | apical | basal | both
  double distance_um = 0.4;
  double stiffness_kPa_per_um = 1;
  double search_um = 6;
  double friction = 0;  // coefficient
};

/// Trigger of cell division: a time, or a measure with a threshold.
enum class DivisionTrigger { time, apical_area, volume, elongation };

/// Apico-basal division planes: across the embryo's axis (x), along the midline (across y), or across the cell's longer
/// side.
enum class DivisionPlane { transverse, sagittal, longest_axis };

struct DivisionInput {
  std::string region;
  std::optional<double> at_s;  // TOML: at_s or at_min
  std::string when;            // area_above_um2 | volume_above_um3 | elongation_above, with a threshold
  std::optional<double> threshold;
  double every_s = 0;                // with `when`: between checks; TOML: every_s or every_min
  std::string plane = "transverse";  // transverse | sagittal | longest-axis
  double growth_s = 300;             // TOML: growth_s or growth_min
  double daughter_volume_ratio = 1;
  std::optional<int> max_generation;  // empty: 1 with `when`, no limit with a time
};

/// Growth of cells without division; program and profile scale the rate.
struct GrowthInput : ActingInput {
  std::optional<double> rate_per_h, final_ratio;  // of the volume; one of them
  std::optional<double> in_plane;                 // empty: isotropic
  std::string axis;                               // along | across; empty: none
  std::optional<double> axis_ratio;
  FollowInput follow;  // signal
};

/// Exchange of neighbours: short lateral faces turn by a quarter.
struct ExchangeInput {
  std::optional<double> below_um;  // empty: no exchange
  std::optional<double> new_length_um;
  double again_after_s = 5;
  std::string region = "all";
};

/// Cells that leave the sheet once they are small, by each bound that is given, and have three walls.
struct ExtrusionInput {
  std::string region;
  std::optional<double> apical_area_below_um2, basal_area_below_um2;
};

struct TimeInput {
  std::optional<double> step_s;             // empty: "adaptive"
  double first_step_s = 0.05;               // adaptive
  double max_step_s = 30;                   // adaptive
  double tolerance_um = 0.05;               // adaptive: local error on positions
  double end_s = 3600;                      // TOML: end_s or end_min
  std::string scheme = "newton";            // newton | linearly-implicit
  std::string integrator = "automatic";     // backward-euler | bdf2 | automatic, which validate() replaces
  std::string linear_solver = "automatic";  // newton: automatic | direct | cholesky | multigrid
  double cg_tolerance = 1e-6;               // linearly-implicit
  int cg_max_iterations = 2000;             // linearly-implicit
};

struct StopInput {
  double equilibrium_speed_um_per_min = 0.2;
  bool at_equilibrium = true;
  std::string combine = "any";  // any | all: of criteria and equilibrium
};

/// Stop criterion: a bound on a monitor, in the unit of its column.
struct CriterionInput {
  std::string monitor;
  std::optional<double> above, below;
  std::string over;  // any | all nodes or cells; empty: the monitor's value
};

struct MonitorInput {
  std::string quantity;
  std::string region = "all";
  std::string face;            // apical | basal; empty: all nodes, or apical for areas
  std::string axis;            // x | y | z; empty: the norm
  std::string from;            // force: exerted by cells of this region, incl. pressures
  std::string over;            // mean | max | min | sum | rms; empty: mean
  std::string reference;       // run directory or mesh file
  std::string reference_at;    // same-time | end; empty: same-time
  std::optional<double> at_s;  // TOML: at_s or at_min; empty: the last value
};

struct MeasureInput {
  std::vector<std::string> sets = {"automatic"};  // measure sets; automatic: those that fit the tissue
};

struct FurrowInput {
  std::string region;           // contractile cells; empty: the largest contracting region
  std::optional<int> vce_cell;  // VCE: midline cell counted from the ends; empty: 2
};

struct OutputInput {
  double frame_every_s = 15;      // TOML: frame_every_s or frame_every_min; 0: only the first and the last
  std::optional<bool> cells_csv;  // empty: up to 2000 cells
};

struct HoldInput {
  std::string region;
  std::vector<std::string> directions = {"x", "y", "z"};
  std::optional<Range> x_um, y_um, z_um;  // only nodes with reference positions in these ranges
};

struct PressureInput : ActingInput {
  double pressure_Pa = 0;  // into the cell; dead load on the reference face
  FollowInput follow;      // signal
};

/// Springs and drag that hold faces to their reference positions; the program scales the springs.
struct FoundationInput : ActingInput {
  FoundationInput() { faces = "basal"; }
  double stiffness_nN_per_um3 = 0;
  double drag_Pa_s_per_um = 0;
  std::string resists = "all";  // all | normal | one-sided
  FollowInput follow;           // signal
};

/// Membrane of extracellular matrix bonded to faces; the program scales its stiffness.
struct MatrixInput : ActingInput {
  MatrixInput() { faces = "basal"; }
  std::optional<double> young_modulus_Pa, thickness_um;
  double prestretch = 1;
  std::optional<double> relaxation_s;
  FollowInput follow;  // signal
};

/// Laser ablation or optogenetic inhibition: loss of cortical and contractile strength.
struct AblationInput {
  std::string region;
  std::vector<std::string> faces = {"apical", "basal", "lateral"};
  std::vector<std::string> only;        // names of tables, such as cortex.apical; empty: all
  std::optional<double> at_s, until_s;  // TOML: at_s or at_min; empty until_s: permanent
  double recovery_s = 0;                // TOML: recovery_s or recovery_min
  std::optional<Range> height_percent;  // of centres of lateral faces; empty: all
  double remaining = 0;                 // residual activity
};

struct ExpectInput {
  double value = 0;
  std::optional<double> within;          // absolute
  std::optional<double> within_percent;  // percent of value
};

/// Place where a key or table was set, for errors found after loading.
struct GivenAt {
  std::string file;
  int line = 0;
};

struct Scenario {
  std::string name;                         // built-in name or file stem
  std::string file;                         // as shown in messages
  std::string builtin;                      // built-in scenario that this is, or its nearest built-in base
  std::map<std::string, GivenAt> given_at;  // by dotted key or table; not part of the model
  int format = 1;
  std::string title;
  EmbryoInput embryo;
  std::map<std::string, RegionInput> regions;
  ElasticityInput elasticity;
  std::map<std::string, RegionElasticityInput> region_elasticities;  // TOML: [elasticity.NAME]
  VolumeInput volume;
  VitellineInput vitelline;
  DynamicsInput dynamics;
  std::map<std::string, ContractionInput> contractions;
  std::map<std::string, CortexInput> cortices;
  std::map<std::string, SignalInput> signals;
  std::map<std::string, EnclosedInput> enclosed;
  SelfContactInput self_contact;
  TimeInput time;
  StopInput stop;
  std::map<std::string, CriterionInput> criteria;  // TOML: [stop.NAME]
  std::map<std::string, MonitorInput> monitors;
  MeasureInput measure;
  FurrowInput furrow;
  OutputInput output;
  std::map<std::string, HoldInput> holds;
  std::map<std::string, PressureInput> pressures;
  std::map<std::string, FoundationInput> foundations;
  std::map<std::string, MatrixInput> matrices;
  std::map<std::string, DivisionInput> divisions;
  std::map<std::string, GrowthInput> growths;
  ExchangeInput exchange;
  std::map<std::string, ExtrusionInput> extrusions;
  std::map<std::string, AblationInput> ablations;
  std::map<std::string, ExpectInput> expect;  // keys of summary.json, including monitors
};

}  // namespace plica
