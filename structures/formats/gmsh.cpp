#include "lacon/structures/formats/gmsh.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/formats/file_names.hpp"
#include "lacon/structures/formats/text_file.hpp"

namespace lacon {
namespace {

namespace fs = std::filesystem;

/// Number of nodes and name of gmsh's types of cells that have no row in cells.toml, to name them in the refusal.
constexpr std::pair<int, std::string_view> unused_types[] = {{13, "gmsh_prism_18"}, {14, "gmsh_pyramid_14"}};

using Entity = std::pair<int, std::int64_t>;  ///< dimension and tag: a geometrical entity, or a physical group

/// The text of a file with a position in it. Numbers come as text or as bytes, as the file's head says.
class Source {
 public:
  Source(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {}

  bool binary = false;

  [[noreturn]] void damaged(const std::string& reason) const {
    fail("GMSH_3", {{"file", file_}, {"section", section_}, {"reason", reason}});
  }
  const std::string& file() const { return file_; }

  /// The name of the next section, "Nodes"; empty at the end of the file. What stands between sections is skipped.
  std::string next_section() {
    while (position_ < text_.size()) {
      const std::string line = rest_of_line();
      if (line.size() > 1 && line[0] == '$') return section_ = line.substr(1);
    }
    return {};
  }

  /// Go behind `$End<section>`, in version 1 `$END<SECTION>`. `was_read`: nothing may be left before it.
  void skip_section(bool was_read) {
    const std::string end = (section_ == "NOD" || section_ == "ELM" ? "$END" : "$End") + section_;
    const std::size_t at = text_.find(end, position_);
    if (at == std::string::npos) damaged(part("gmsh_no_end", {{"end", end}}));
    if (was_read && text_.find_first_not_of(" \t\r\n", position_) < at) damaged(part("gmsh_more_there"));
    position_ = at + end.size();
    rest_of_line();
  }

  std::string rest_of_line() {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string line = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    return line;
  }

  /// A number that is text, whatever the rest of the file is. Behind it comes the end of the line.
  std::int64_t text_integer() { return parsed<std::int64_t>("a_whole_number"); }
  double text_real() { return parsed<double>("a_number"); }
  std::int64_t integer() { return binary ? bytes<std::int32_t>() : text_integer(); }
  std::int64_t size() { return binary ? static_cast<std::int64_t>(bytes<std::uint64_t>()) : text_integer(); }
  double real() { return binary ? bytes<double>() : text_real(); }

  /// A count of things that take `least` bytes at least: a spoilt file may claim any number.
  std::size_t count(std::int64_t n, std::size_t least) const {
    if (n < 0 || static_cast<std::uint64_t>(n) > (text_.size() - position_) / least)
      damaged(part("gmsh_too_short", {{"count", std::to_string(n)}}));
    return static_cast<std::size_t>(n);
  }

  /// How many members all groups may have: a file may put each of many cells into each of many groups (docs/trust.md).
  std::size_t most_memberships() const { return 8 * text_.size(); }

  std::string quoted() {
    const std::size_t open = text_.find('"', position_), close = text_.find('"', open == std::string::npos ? open : open + 1);
    if (close == std::string::npos) damaged(part("gmsh_not_quoted"));
    position_ = close + 1;
    return text_.substr(open + 1, close - open - 1);
  }

 private:
  template <class T>
  T parsed(const char* what) {
    while (position_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[position_]))) ++position_;
    T value{};
    const char* from = text_.data() + position_;
    const auto [end, error] = std::from_chars(from, text_.data() + text_.size(), value);
    if (error != std::errc()) {
      const std::size_t stop = std::min(text_.find_first_of(" \t\r\n", position_), text_.size());
      const std::string found = text_.substr(position_, std::min<std::size_t>(stop - position_, 30));
      damaged(found.empty() ? part("it_ends_where", {{"expected", part(what)}})
                            : part("there_is_where", {{"found", "'" + found + "'"}, {"expected", part(what)}}));
    }
    position_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  template <class T>
  T bytes() {
    if (text_.size() - position_ < sizeof(T)) damaged(part("it_is_cut_off"));
    T value;
    std::memcpy(&value, text_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    return value;
  }

  std::string file_, text_;
  std::string section_ = "MeshFormat";
  std::size_t position_ = 0;
};

/// Reads one file, section by section; finish() makes the mesh.
class GmshReader {
 public:
  explicit GmshReader(Source& source) : source_(source) {}

  void read() {
    const std::set<std::string> known = {"PhysicalNames", "Entities", "Nodes", "Elements", "NOD", "ELM"};
    bool nodes = false, elements = false;
    for (std::string section = source_.next_section(); !section.empty(); section = source_.next_section()) {
      if (section == "PartitionedEntities") fail("GMSH_6", {{"file", source_.file()}});
      if (section == "PhysicalNames") physical_names();
      if (section == "Entities") entities();
      if (section == "Nodes") nodes = true, version_4_ ? nodes_4() : nodes_2();
      if (section == "Elements") elements = true, version_4_ ? elements_4() : elements_2();
      if (section == "NOD") nodes = true, nodes_2();  // of version 1, as text in version 2
      if (section == "ELM") elements = true, elements_1();
      source_.skip_section(known.contains(section));
    }
    if (!nodes) source_.damaged(part("gmsh_no_nodes"));
    if (!elements || cells_.empty()) source_.damaged(part("file_no_cells"));
  }

  /// What goes before the sections of a file of version 2 or later; version 1 has nothing.
  void head() {
    if (source_.next_section() != "MeshFormat") fail("GMSH_1", {{"file", source_.file()}});
    const double version = source_.text_real();
    const std::int64_t mode = source_.text_integer(), real_size = source_.text_integer();
    source_.rest_of_line();
    version_4_ = version >= 4;
    version_4_0_ = version_4_ && version < 4.1;
    if (!(version >= 2 && version < 3) && !(version >= 4 && version < 5))
      fail("GMSH_2", {{"file", source_.file()}, {"version", std::to_string(version).substr(0, 3)}});
    source_.binary = mode != 0;
    if (source_.binary && (real_size != 8 || source_.integer() != 1)) source_.damaged(part("gmsh_other_machine"));
    source_.skip_section(true);
  }

  Mesh finish(std::string name);

 private:
  struct Cell {
    CellType type;
    std::int64_t tag;
    std::size_t first;                   ///< of its nodes in nodes_
    std::vector<std::int64_t> physical;  ///< tags of its groups
  };

  void physical_names() {
    const std::size_t n = source_.count(source_.text_integer(), 4);
    for (std::size_t i = 0; i < n; ++i) {
      const int dimension = static_cast<int>(source_.text_integer());
      const std::int64_t tag = source_.text_integer();
      names_[{dimension, tag}] = file_names_.read(source_.quoted());
    }
  }

  void entities() {
    std::size_t n[4];
    for (std::size_t& count : n) count = source_.count(source_.size(), 8);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < n[dimension]; ++i) {
        const std::int64_t tag = source_.integer();
        for (int k = 0; k < (dimension == 0 && !version_4_0_ ? 3 : 6); ++k) source_.real();
        auto& groups = physical_of_[{dimension, tag}];
        const std::size_t n_groups = source_.count(source_.size(), 2);
        for (std::size_t g = 0; g < n_groups; ++g) groups.push_back(std::abs(source_.integer()));
        if (dimension == 0) continue;
        const std::size_t n_bounding = source_.count(source_.size(), 2);
        for (std::size_t b = 0; b < n_bounding; ++b) source_.integer();
      }
  }

  void add_node(std::int64_t tag, double x, double y, double z) {
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
      source_.damaged(part("node_not_finite", {{"node", std::to_string(tag)}}));
    if (!number_.emplace(tag, static_cast<std::int32_t>(coordinates_.size() / 3)).second)
      source_.damaged(part("node_is_there_twice", {{"node", std::to_string(tag)}}));
    coordinates_.insert(coordinates_.end(), {x, y, z});
  }

  void nodes_2() {
    const std::size_t n = source_.count(source_.text_integer(), 8);
    if (source_.binary) source_.rest_of_line();
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t tag = source_.integer();
      const double x = source_.real(), y = source_.real(), z = source_.real();
      add_node(tag, x, y, z);
    }
  }

  /// Read the blocks of nodes or cells: before them is how many there are, of what they have in all, and from 4.1 on the least
  /// and largest tags. `read_block` returns how many it has.
  template <class ReadBlock>
  void blocks_4(const ReadBlock& read_block) {
    const std::size_t blocks = source_.count(source_.size(), 4), total = source_.count(source_.size(), 4);
    for (int k = 0; k < 2 && !version_4_0_; ++k) source_.size();
    std::size_t found = 0;
    for (std::size_t block = 0; block < blocks; ++block) found += read_block();
    if (found != total)
      source_.damaged(part("gmsh_other_total", {{"count", std::to_string(total)}, {"found", std::to_string(found)}}));
  }
  Entity entity_4() {
    const std::int64_t first = source_.integer(), second = source_.integer();
    return version_4_0_ ? Entity(static_cast<int>(second), first) : Entity(static_cast<int>(first), second);
  }
  std::int64_t tag_4() { return version_4_0_ ? source_.integer() : source_.size(); }

  void nodes_4() {
    blocks_4([&] {
      const std::int64_t dimension = entity_4().first;
      const bool parametric = source_.integer() != 0;
      const std::size_t n = source_.count(source_.size(), 8);
      std::vector<std::int64_t> tags;  // in 4.0 each before its coordinates
      for (std::size_t i = 0; i < n && !version_4_0_; ++i) tags.push_back(source_.size());
      for (std::size_t i = 0; i < n; ++i) {
        const std::int64_t tag = version_4_0_ ? source_.integer() : tags[i];
        const double x = source_.real(), y = source_.real(), z = source_.real();
        for (std::int64_t k = 0; parametric && k < dimension; ++k) source_.real();
        add_node(tag, x, y, z);
      }
      return n;
    });
  }

  const catalog::CellRow& row_of(std::int64_t type) const {
    for (const catalog::CellRow& row : catalog::cells())
      if (row.gmsh_type == type) return row;
    std::string what = part("gmsh_of_type", {{"type", std::to_string(type)}});
    for (const auto& [number, name] : unused_types)
      if (number == type) what = part(name);
    fail("GMSH_4", {{"file", source_.file()}, {"type", what}});
  }

  template <class Next>
  void add_cell(const catalog::CellRow& row, std::int64_t tag, std::vector<std::int64_t> physical, const Next& next) {
    memberships_ += physical.size();
    if (memberships_ > source_.most_memberships()) source_.damaged(part("too_many_members"));
    cells_.push_back({row.type, tag, nodes_.size(), std::move(physical)});
    for (int j = 0; j < row.n_nodes; ++j) nodes_.push_back(next());
  }

  void elements_1() {
    const std::size_t n = source_.count(source_.text_integer(), 8);
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t tag = source_.integer();
      const catalog::CellRow& row = row_of(source_.integer());
      const std::int64_t physical = source_.integer();
      source_.integer();  // the geometrical entity
      if (const std::int64_t n_nodes = source_.integer(); n_nodes != row.n_nodes)
        source_.damaged(
            part("gmsh_wrong_nodes",
                 {{"type", std::string(row.name)}, {"cell", std::to_string(tag)}, {"count", std::to_string(n_nodes)}}));
      add_cell(row, tag, physical != 0 ? std::vector<std::int64_t>{std::abs(physical)} : std::vector<std::int64_t>{},
               [&] { return source_.integer(); });
    }
  }

  void elements_2() {
    std::size_t n = source_.count(source_.text_integer(), 8);
    if (source_.binary) source_.rest_of_line();
    while (n > 0) {
      // as text each cell has its head; as bytes a head may serve for several
      std::int64_t tag = source_.binary ? 0 : source_.integer();
      const catalog::CellRow& row = row_of(source_.integer());
      const std::size_t follow = source_.binary ? source_.count(source_.integer(), 4) : 1;
      const std::size_t n_tags = source_.count(source_.integer(), 1);
      if (follow == 0 || follow > n) source_.damaged(part("gmsh_block_of", {{"count", std::to_string(follow)}}));
      for (std::size_t i = 0; i < follow; ++i, --n) {
        if (source_.binary) tag = source_.integer();
        std::vector<std::int64_t> physical;
        for (std::size_t k = 0; k < n_tags; ++k) {
          const std::int64_t value = source_.integer();
          if (k == 0 && value != 0) physical.push_back(std::abs(value));
          if (k == 2 && value > 1) fail("GMSH_6", {{"file", source_.file()}});
        }
        add_cell(row, tag, std::move(physical), [&] { return source_.integer(); });
      }
    }
  }

  void elements_4() {
    blocks_4([&] {
      const Entity entity = entity_4();
      const catalog::CellRow& row = row_of(source_.integer());
      const std::size_t n = source_.count(source_.size(), 4);
      for (std::size_t i = 0; i < n; ++i) {
        const std::int64_t tag = tag_4();
        add_cell(row, tag, physical_of_[entity], [&] { return tag_4(); });
      }
      return n;
    });
  }

  std::string group_name(int dimension, std::int64_t tag) const {
    const auto named = names_.find({dimension, tag});
    return named != names_.end() && !named->second.empty() ? named->second : "GM" + std::to_string(tag);
  }

  Source& source_;
  FileNames file_names_;
  bool version_4_ = false, version_4_0_ = false;
  std::map<Entity, std::string> names_;                      ///< of physical groups
  std::map<Entity, std::vector<std::int64_t>> physical_of_;  ///< groups of each geometrical entity
  std::unordered_map<std::int64_t, std::int32_t> number_;    ///< of a node by its tag
  std::vector<double> coordinates_;
  std::vector<Cell> cells_;
  std::size_t memberships_ = 0;      ///< of cells in physical groups
  std::vector<std::int64_t> nodes_;  ///< tags, cell by cell, in gmsh's order
};

Mesh GmshReader::finish(std::string name) {
  file_names_.tell(source_.file());
  Mesh mesh;
  mesh.name = std::move(name);
  mesh.coordinates = std::move(coordinates_);
  std::map<std::string, std::vector<std::int32_t>> cell_groups, node_groups;
  for (const auto& [group, text] : names_) cell_groups[group_name(group.first, group.second)];
  for (const catalog::CellRow& row : catalog::cells()) {
    // version 2 writes a cell once for each of its physical groups
    std::map<std::vector<std::int32_t>, std::pair<std::int32_t, std::set<std::int64_t>>> known;
    for (const Cell& cell : cells_) {
      if (cell.type != row.type) continue;
      std::vector<std::int32_t> own;
      for (const std::int8_t j : row.gmsh_permutation) {
        const std::int64_t tag = nodes_[cell.first + static_cast<std::size_t>(j)];
        const auto node = number_.find(tag);
        if (node == number_.end())
          fail("GMSH_5", {{"file", source_.file()},
                          {"type", std::string(row.name)},
                          {"cell", std::to_string(cell.tag)},
                          {"node", std::to_string(tag)}});
        own.push_back(node->second);
      }
      auto number = static_cast<std::int32_t>(mesh.n_cells());
      bool fresh = true;
      if (!version_4_ && !cell.physical.empty()) {
        auto& [first, groups] = known.try_emplace(own, number, std::set<std::int64_t>{}).first->second;
        if (groups.insert(cell.physical[0]).second && first != number) {
          number = first;
          fresh = false;
        }
      }
      if (fresh) mesh.add_cell(row.type, own);
      for (const std::int64_t physical : cell.physical) {
        const std::string group = group_name(row.dimension, physical);
        auto& members = cell_groups[group];
        if (members.empty() || members.back() != number) members.push_back(number);
        if (row.dimension == 0) node_groups[group].push_back(own[0]);
      }
    }
  }
  for (auto& [group, members] : cell_groups) mesh.cell_groups.push_back({group, std::move(members)});
  for (auto& [group, members] : node_groups) mesh.node_groups.push_back({group, std::move(members)});
  mesh.dimension = least_dimension(mesh);
  return mesh;
}

}  // namespace

Mesh read_gmsh_mesh(const fs::path& file) {
  if (!first_bytes(file, 11).starts_with("$")) fail("GMSH_1", {{"file", file.string()}});
  Source source(file.string(), read_text(file));
  GmshReader reader(source);
  if (!first_bytes(file, 4).starts_with("$NOD")) reader.head();
  reader.read();
  return reader.finish(file.stem().string());
}

}  // namespace lacon
