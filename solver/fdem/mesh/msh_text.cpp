// Grammar: Gmsh reference manual, "MSH file format" (4.1) and "MSH file format version 2 (Legacy)".
#include "solver/fdem/mesh/msh_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>

#include "common/base/text.hpp"
#include "solver/fdem/mesh/msh_words.hpp"

namespace fracfarm::fdem {
namespace {

constexpr double most_metres = 1e6;  // a coordinate's size
constexpr std::string_view crack_group = "cracks";
constexpr long long line_type = 1, triangle_type = 2, point_type = 15;

int node_count_of(long long type) { return type == line_type ? 2 : type == triangle_type ? 3 : type == point_type ? 1 : 0; }

class MshReader {
 public:
  explicit MshReader(std::string_view bytes) : words_(bytes) {}

  tl::expected<MshContent, std::string> run() {
    for (std::string_view section = words_.word(); !section.empty() && error_.empty(); section = words_.word()) read_section(section);
    if (error_.empty()) resolve();
    if (!error_.empty()) return tl::unexpected(error_);
    return std::move(content_);
  }

 private:
  struct Element {
    std::array<std::int64_t, 3> nodes{};  // tags
    bool triangle = true;
  };

  void fail(std::string what) {
    if (error_.empty()) error_ = fmt::format("line {}: {}", words_.line(), what);
  }

  template <class Number>
  Number number(std::string_view what) {
    const auto value = words_.number<Number>();
    if (!value) fail(fmt::format("{} must stand here", what));
    return value.value_or(Number{});
  }
  std::int64_t integer(std::string_view what) { return number<std::int64_t>(what); }
  std::size_t count(std::string_view what) {
    const auto value = words_.count();
    if (!value) fail(fmt::format("{} must stand here, at most what the file can hold", what));
    return value.value_or(0);
  }

  void read_section(std::string_view section) {
    if (!section.starts_with('$')) return fail(fmt::format("'{}' stands where a section must begin", section.substr(0, 40)));
    if (section != "$MeshFormat" && version_ == 0 && section != "$Comments") return fail("the file must begin with $MeshFormat");
    if (section == "$MeshFormat") read_format();
    if (section == "$PhysicalNames") read_names();
    if (section == "$Entities" && version_ == 41) read_entities();
    if (section == "$Nodes") version_ == 41 ? read_nodes_41() : read_nodes_22();
    if (section == "$Elements") version_ == 41 ? read_elements_41() : read_elements_22();
    const std::string end = "$End" + std::string(section.substr(1));
    if (error_.empty() && !words_.skip_past(end)) fail(fmt::format("{} is missing", end.substr(0, 40)));
  }

  void read_format() {
    const std::string_view version = words_.word();
    version_ = version == "2.2" || version == "2.1" || version == "2" ? 22 : version == "4.1" ? 41 : 0;
    if (version_ == 0) return fail(fmt::format("version {} of MSH; 2.2 and 4.1 are read", version.substr(0, 20)));
    if (integer("0 for ASCII") != 0) fail("a binary file; write it as ASCII (gmsh -format msh22, Mesh.Binary = 0)");
  }

  void read_names() {
    for (std::size_t i = 0, n = count("the number of names"); i < n && error_.empty(); ++i) {
      const std::int64_t dimension = integer("a dimension"), tag = integer("a tag");
      std::string_view name = words_.rest_of_line();
      if (name.starts_with('"') && name.ends_with('"') && name.size() >= 2) name = name.substr(1, name.size() - 2);
      if (dimension == 1 && name == crack_group) crack_tag_ = tag, content_.names_cracks = true;
    }
  }

  // Of 4.1 only which curves belong to the cracks.
  void read_entities() {
    const std::size_t points = count("the number of points"), curves = count("the number of curves");
    count("the number of surfaces"), count("the number of volumes");
    for (std::size_t i = 0; i < points && error_.empty(); ++i) {
      integer("a point's tag");
      for (int k = 0; k < 3; ++k) number<double>("a coordinate");
      for (std::size_t k = 0, n = count("the number of physical tags"); k < n && error_.empty(); ++k) integer("a physical tag");
    }
    for (std::size_t i = 0; i < curves && error_.empty(); ++i) {
      const std::int64_t tag = integer("a curve's tag");
      for (int k = 0; k < 6; ++k) number<double>("a bound");
      for (std::size_t k = 0, n = count("the number of physical tags"); k < n && error_.empty(); ++k)
        if (integer("a physical tag") == crack_tag_ && content_.names_cracks) crack_curves_.insert(tag);
      for (std::size_t k = 0, n = count("the number of bounding points"); k < n && error_.empty(); ++k) integer("a point's tag");
    }
  }

  void read_place() {
    std::array<double, 3> place{};
    for (double& value : place) {
      value = number<double>("a coordinate");
      if (!(std::fabs(value) <= most_metres)) fail(fmt::format("a coordinate must be finite and at most {} m", most_metres));
    }
    content_.nodes.push_back(place);
  }

  void read_nodes_22() {
    for (std::size_t i = 0, n = count("the number of nodes"); i < n && error_.empty(); ++i) {
      tags_.emplace_back(integer("a node's number"), static_cast<int>(content_.nodes.size()));
      read_place();
    }
  }

  void read_nodes_41() {
    const std::size_t blocks = count("the number of blocks");
    for (const std::string_view what : {"the number of nodes", "the least tag", "the largest tag"}) integer(what);
    for (std::size_t block = 0; block < blocks && error_.empty(); ++block) {
      const std::int64_t dimension = integer("a dimension");
      integer("an entity");
      const std::int64_t parameters = integer("0 or 1") == 1 ? dimension : 0;
      const std::size_t n = count("the number of nodes of the block");
      if (parameters < 0 || parameters > 3) fail("a dimension is 0 to 3");
      for (std::size_t i = 0; i < n && error_.empty(); ++i)
        tags_.emplace_back(integer("a node's tag"), static_cast<int>(content_.nodes.size() + i));
      for (std::size_t i = 0; i < n && error_.empty(); ++i) {
        read_place();
        for (std::int64_t k = 0; k < parameters; ++k) number<double>("a parameter");
      }
    }
  }

  void read_element(long long type, bool of_cracks) {
    Element element;
    const int nodes = node_count_of(type);
    for (int k = 0; k < nodes; ++k) element.nodes[static_cast<std::size_t>(k)] = integer("a node's number");
    element.triangle = type == triangle_type;
    if (element.triangle || (type == line_type && of_cracks)) elements_.push_back(element);
  }

  bool known(long long type) {
    if (node_count_of(type) == 0)
      fail(fmt::format("an element of type {}; allowed: 2 (three-node triangle), 1 (two-node line), 15 (point)", type));
    return node_count_of(type) != 0;
  }

  void read_elements_22() {
    for (std::size_t i = 0, n = count("the number of elements"); i < n && error_.empty(); ++i) {
      integer("an element's number");
      const std::int64_t type = integer("an element's type");
      const std::size_t tags = count("the number of tags");
      std::int64_t physical = 0;
      for (std::size_t k = 0; k < tags && error_.empty(); ++k) (k == 0 ? physical : ignored_) = integer("a tag");
      if (error_.empty() && known(type)) read_element(type, content_.names_cracks && physical == crack_tag_);
    }
  }

  void read_elements_41() {
    const std::size_t blocks = count("the number of blocks");
    for (const std::string_view what : {"the number of elements", "the least tag", "the largest tag"}) integer(what);
    for (std::size_t block = 0; block < blocks && error_.empty(); ++block) {
      const std::int64_t dimension = integer("a dimension"), entity = integer("an entity"), type = integer("an element's type");
      const std::size_t n = count("the number of elements of the block");
      if (!error_.empty() || !known(type)) return;
      for (std::size_t i = 0; i < n && error_.empty(); ++i) {
        integer("an element's tag");
        read_element(type, dimension == 1 && crack_curves_.contains(entity));
      }
    }
  }

  // Tags into places.
  void resolve() {
    if (version_ == 0) return void(error_ = "the file has no $MeshFormat: it is no MSH file");
    std::sort(tags_.begin(), tags_.end());
    for (std::size_t i = 1; i < tags_.size(); ++i)
      if (tags_[i].first == tags_[i - 1].first) return void(error_ = fmt::format("node {} is given twice", tags_[i].first));
    for (const Element& element : elements_) {
      std::array<int, 3> places{};
      for (std::size_t k = 0; k < (element.triangle ? 3u : 2u); ++k) {
        const auto found = std::lower_bound(tags_.begin(), tags_.end(), std::pair{element.nodes[k], -1});
        if (found == tags_.end() || found->first != element.nodes[k])
          return void(error_ = fmt::format("an element has the node {}, which is not there", element.nodes[k]));
        places[k] = found->second;
      }
      if (element.triangle)
        content_.triangles.push_back(places);
      else
        content_.crack_edges.emplace_back(places[0], places[1]);
    }
  }

  MshWords words_;
  MshContent content_;
  std::string error_;
  int version_ = 0;  // 22, 41
  std::int64_t crack_tag_ = 0, ignored_ = 0;
  std::set<std::int64_t> crack_curves_;
  std::vector<std::pair<std::int64_t, int>> tags_;  // of nodes, and their places
  std::vector<Element> elements_;
};

}  // namespace

tl::expected<MshContent, std::string> parse_msh(std::string_view bytes) { return MshReader(bytes).run(); }

std::string write_msh(const TriangleMesh& mesh) {
  const auto cracks = static_cast<std::size_t>(std::count(mesh.edge_kind.begin(), mesh.edge_kind.end(), EdgeKind::crack));
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"cracks\"\n2 2 \"body\"\n$EndPhysicalNames\n";
  out += fmt::format("$Nodes\n{}\n", mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) out += fmt::format("{} {} {} 0\n", i + 1, mesh.nodes[i][0], mesh.nodes[i][1]);
  out += fmt::format("$EndNodes\n$Elements\n{}\n", cracks + mesh.triangles.size());
  std::size_t number = 0;
  for (std::size_t e = 0; e < mesh.edge_nodes.size(); ++e)
    if (mesh.edge_kind[e] == EdgeKind::crack)
      out += fmt::format("{} 1 2 1 1 {} {}\n", ++number, mesh.edge_nodes[e][0] + 1, mesh.edge_nodes[e][1] + 1);
  for (const auto& [a, b, c] : mesh.triangles) out += fmt::format("{} 2 2 2 2 {} {} {}\n", ++number, a + 1, b + 1, c + 1);
  return out += "$EndElements\n";
}

}  // namespace fracfarm::fdem
