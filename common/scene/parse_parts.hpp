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
std::vector<SideLoad> read_side(const nlohmann::json& value, const std::string& path, double length, ProblemList& problems);
nlohmann::json side_json(const std::vector<SideLoad>& parts, double length);
double side_length(const Scene& scene, Side side);

// Smallest h / sqrt((C_max + C55) / rho) over the layers, s: cfl = 1.
double step_edge(const Scene& scene);
// What secant means where no layer yields is `none`; both spellings are one scene.
PlasticityModel effective_plasticity(const Scene& scene);

// Spellings of files; name_of() prints by them too.
inline constexpr std::array<Word<Method>, 1> method_words{{{"phase_field", Method::phase_field}}};
inline constexpr std::array<Word<CrackSet>, 2> crack_set_words{{{"orthogonal", CrackSet::orthogonal}, {"oblique", CrackSet::oblique}}};
inline constexpr std::array<Word<Side>, 4> side_words{
    {{"left", Side::left}, {"right", Side::right}, {"bottom", Side::bottom}, {"top", Side::top}}};
inline constexpr std::array<Word<Stop>, 2> stop_words{{{"failure", Stop::failure}, {"horizon", Stop::horizon}}};
inline constexpr std::array<Word<CrackSeeding>, 1> seeding_words{{{"slot", CrackSeeding::slot}}};
inline constexpr std::array<Word<PlasticityModel>, 2> plasticity_words{
    {{"none", PlasticityModel::none}, {"secant", PlasticityModel::secant}}};
inline constexpr std::array<Word<LengthScale::Kind>, 2> length_scale_words{
    {{"half", LengthScale::Kind::half}, {"full", LengthScale::Kind::full}}};

template <class E, std::size_t N>
constexpr std::string_view spelled(const std::array<Word<E>, N>& table, E value) {
  for (const Word<E>& word : table)
    if (word.value == value) return word.name;
  return {};
}

}  // namespace fracfarm
