// Pieces of parse_scene, one file each, and what the sample maker shares with it. Not for other rooms.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "common/scene/fields.hpp"
#include "common/scene/scene.hpp"

namespace fracfarm {

// The scene grammar over a JSON value that was read already.
Parsed<Scene> scene_from_json(const nlohmann::json& file);

// A table name, an object of properties, or layers; always at least one layer, the last one reaching `height`.
// width_needed: the length scale is a part of the characteristic width, so the width must be given.
std::vector<Layer> read_layers(const nlohmann::json& value, double height, bool width_needed, ProblemList& problems);
// The properties as a scene file spells them: the name of a table row, or every property of any other material.
nlohmann::json material_json(const Material& material);
nlohmann::json material_properties(const Material& material);

// "free" | "fixed" | object | list of objects; parts sorted along the side, never overlapping.
std::vector<SideLoad> read_side(const nlohmann::json& value, const std::string& path, Side side, double length, ProblemList& problems);
nlohmann::json side_json(const std::vector<SideLoad>& parts, double length);
double side_length(const Scene& scene, Side side);

// Smallest h / sqrt((C_max + C55) / rho) over the layers, s: cfl = 1.
double step_edge(const Scene& scene);
// What secant means where no layer yields is `none`; both spellings are one scene.
PlasticityModel effective_plasticity(const Scene& scene);

// The keys of the phase_field block, what they may not be together, and their canonical spelling (settings with no effect are left out).
void read_phase_field(Fields& top, Scene& scene);
void check_phase_field(const Scene& scene, ProblemList& problems);
nlohmann::json phase_field_json(const Scene& scene);

// The same of the fdem block; a key that follows the tier and was not given is left out.
void read_fdem(Fields& top, Scene& scene);
void check_fdem(const Scene& scene, ProblemList& problems);
nlohmann::json fdem_json(const Scene& scene);
double triangle_count(const Scene& scene);  // about

// Scenes of method drill, which have no body: their whole grammar.
bool is_drill(const nlohmann::json& file);
Parsed<Scene> drill_from_json(const nlohmann::json& file);
nlohmann::json drill_json(const Scene& scene);

// Spellings of files; name_of() prints by them too.
inline constexpr std::array<Word<Method>, 3> method_words{
    {{"phase_field", Method::phase_field}, {"fdem", Method::fdem}, {"drill", Method::drill}}};
inline constexpr std::array<Word<DrillAct>, 9> drill_act_words{{{"sleep", DrillAct::sleep},
                                                                {"crash", DrillAct::crash},
                                                                {"hang", DrillAct::hang},
                                                                {"leak", DrillAct::leak},
                                                                {"truncated", DrillAct::truncated},
                                                                {"bit_flipped", DrillAct::bit_flipped},
                                                                {"wrong_job", DrillAct::wrong_job},
                                                                {"nan", DrillAct::nan},
                                                                {"ignore_term", DrillAct::ignore_term}}};
inline constexpr std::array<Word<FdemTier>, 3> tier_words{
    {{"reference", FdemTier::reference}, {"fast", FdemTier::fast}, {"screening", FdemTier::screening}}};
inline constexpr std::array<Word<Softening>, 2> softening_words{{{"munjiza", Softening::munjiza}, {"linear", Softening::linear}}};
inline constexpr std::array<Word<CrackSet>, 2> crack_set_words{{{"orthogonal", CrackSet::orthogonal}, {"oblique", CrackSet::oblique}}};
inline constexpr std::array<Word<Side>, 4> side_words{
    {{"left", Side::left}, {"right", Side::right}, {"bottom", Side::bottom}, {"top", Side::top}}};
inline constexpr std::array<Word<Stop>, 3> stop_words{{{"failure", Stop::failure}, {"drop10", Stop::drop10}, {"horizon", Stop::horizon}}};
inline constexpr std::array<Word<StepControl>, 2> step_control_words{{{"fixed", StepControl::fixed}, {"adaptive", StepControl::adaptive}}};
inline constexpr std::array<Word<CrackSeeding>, 3> seeding_words{
    {{"slot", CrackSeeding::slot}, {"nodes", CrackSeeding::nodes}, {"history", CrackSeeding::history}}};
inline constexpr std::array<Word<SurfaceModel>, 2> surface_words{{{"at2", SurfaceModel::at2}, {"at1", SurfaceModel::at1}}};
inline constexpr std::array<Word<Plane>, 2> plane_words{{{"strain", Plane::strain}, {"stress", Plane::stress}}};
inline constexpr std::array<Word<Split>, 5> split_words{{{"seed", Split::seed},
                                                         {"none", Split::none},
                                                         {"spectral", Split::spectral},
                                                         {"volumetric_deviatoric", Split::volumetric_deviatoric},
                                                         {"star_convex", Split::star_convex}}};
inline constexpr std::array<Word<PlasticityModel>, 3> plasticity_words{
    {{"none", PlasticityModel::none}, {"secant", PlasticityModel::secant}, {"j2", PlasticityModel::j2}}};
inline constexpr std::array<Word<Quadrature>, 2> quadrature_words{{{"gll", Quadrature::gll}, {"gauss", Quadrature::gauss}}};
inline constexpr std::array<Word<Precision>, 2> precision_words{{{"double", Precision::double_}, {"float", Precision::float_}}};
inline constexpr std::array<Word<Integrator>, 3> integrator_words{
    {{"explicit", Integrator::explicit_central}, {"newmark", Integrator::newmark}, {"quasi_static", Integrator::quasi_static}}};
inline constexpr std::array<Word<LengthScale::Kind>, 2> length_scale_words{
    {{"half", LengthScale::Kind::half}, {"full", LengthScale::Kind::full}}};

template <class E, std::size_t N>
constexpr std::string_view spelled(const std::array<Word<E>, N>& table, E value) {
  for (const Word<E>& word : table)
    if (word.value == value) return word.name;
  return {};
}

}  // namespace fracfarm
