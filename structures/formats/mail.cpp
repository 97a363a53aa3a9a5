#include "lacon/structures/formats/mail.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/text.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/formats/file_names.hpp"
#include "lacon/structures/formats/text_file.hpp"
#include "lacon/structures/names.hpp"

namespace lacon {
namespace {

namespace fs = std::filesystem;

/// Cells of code_aster that have no row in cells.toml, to name them in the refusal.
constexpr std::string_view other_types[] = {"SEG4",   "SEG22",  "SEG33",  "TRIA7",   "TRIA33",  "TRIA66",
                                            "QUAD44", "QUAD88", "QUAD99", "PENTA18", "PENTA21", "PYRAM19"};

/// Nodes (likewise cells) with names of their own up to this number are found by them.
constexpr std::size_t most_names = 200;

/// A word of the file and its line.
struct Word {
  std::string_view text;
  std::size_t line = 0;
};

/// The words of a text: between blanks, without comments (from % to the end of the line); '=' is a word of its own.
class Words {
 public:
  Words(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {}

  [[noreturn]] void damaged(std::size_t line, const std::string& reason) const {
    fail("MAIL_1", {{"file", file_}, {"line", std::to_string(line)}, {"reason", reason}});
  }
  const std::string& file() const { return file_; }

  /// The next word; empty at the end of the file.
  Word next() {
    const Word word = peek();
    position_ = end_;
    return word;
  }
  /// The next word, which stays the next one.
  Word peek() {
    for (; position_ < text_.size(); ++position_) {
      if (text_[position_] == '%') position_ = std::min(text_.find('\n', position_), text_.size() - 1);
      if (text_[position_] == '\n')
        ++line_;
      else if (!is_blank(text_[position_]))
        break;
    }
    end_ = position_;
    if (end_ < text_.size() && text_[end_] == '=')
      ++end_;
    else
      while (end_ < text_.size() && !is_blank(text_[end_]) && text_[end_] != '\n' && text_[end_] != '=' && text_[end_] != '%')
        ++end_;
    return {text_.substr(position_, end_ - position_), line_};
  }
  void skip_line() {
    position_ = std::min(text_.find('\n', position_), text_.size());
    if (position_ < text_.size()) ++position_, ++line_;
  }
  std::size_t line() const { return line_; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f'; }

  std::string file_;
  std::string_view text_;
  std::size_t position_ = 0, end_ = 0, line_ = 1;
};

/// A word as messages show it.
std::string shown(std::string_view word) { return "'" + as_utf8(std::string(word.substr(0, 30))) + "'"; }

/// Reads one file, part by part ("sous-fichier"); finish() makes the mesh.
class MailReader {
 public:
  explicit MailReader(Words& words) : words_(words) {}

  void read() {
    for (;;) {
      const Word keyword = words_.next();
      if (keyword.text.empty()) words_.damaged(keyword.line, part("mail_no_fin"));
      if (keyword.text == "FIN") return;
      if (keyword.text == "TITRE")
        skip_title(keyword);
      else if (keyword.text == "COOR_2D" || keyword.text == "COOR_3D")
        read_nodes(keyword);
      else if (keyword.text == "GROUP_NO" || keyword.text == "GROUP_MA")
        read_group(keyword);
      else if (const auto type = catalog::find_cell(keyword.text))
        read_cells(keyword, catalog::cell(*type));
      else
        refuse(keyword);
    }
  }

  Mesh finish(std::string name);

 private:
  struct Named {
    std::string_view group;
    bool of_nodes;
    std::vector<Word> members;
  };
  using Numbers = std::unordered_map<std::string_view, std::int32_t>;

  [[noreturn]] void refuse(const Word& keyword) const {
    if (std::ranges::find(other_types, keyword.text) != std::end(other_types))
      fail("MAIL_2", {{"file", words_.file()}, {"line", std::to_string(keyword.line)}, {"type", std::string(keyword.text)}});
    words_.damaged(keyword.line,
                   part("there_is_where", {{"found", shown(keyword.text)}, {"expected", part("mail_beginnings")}}));
  }

  /// The next word of a part that began with `keyword`; empty at its end, FINSF.
  Word item(const Word& keyword) {
    const Word word = words_.next();
    if (word.text.empty())
      words_.damaged(word.line,
                     part("mail_no_finsf", {{"keyword", std::string(keyword.text)}, {"line", std::to_string(keyword.line)}}));
    if (word.text == "FINSF") return {{}, word.line};
    return word;
  }

  void skip_title(const Word& keyword) {
    for (words_.skip_line(); words_.peek().text != "FINSF"; words_.skip_line())
      if (words_.peek().text.empty()) item(keyword);
    words_.next();
  }

  /// What stands behind a keyword as KEY=VALUE; NBLIGE says how many lines that takes. @return the value of NOM
  std::string_view skip_head(const Word& keyword) {
    std::string_view name;
    std::size_t lines = 0;
    for (Words ahead = words_; ahead.next().text != "FINSF" && ahead.peek().text == "=";) {
      const std::string_view key = words_.next().text;
      words_.next();
      const Word value = words_.next();
      if (value.text.empty()) words_.damaged(value.line, part("mail_no_value", {{"keyword", std::string(key)}}));
      if (key == "NOM" && value.text != "INDEFINI") name = value.text;
      if (key == "NBLIGE") std::from_chars(value.text.data(), value.text.data() + value.text.size(), lines);
      ahead = words_;
    }
    while (words_.line() < keyword.line + std::min<std::size_t>(lines, 100) && !words_.peek().text.empty() &&
           words_.peek().line < keyword.line + lines)
      words_.skip_line();
    return name;
  }

  double real(const Word& keyword, std::string_view node) {
    const Word word = item(keyword);
    std::string text(word.text.substr(word.text.starts_with('+') ? 1 : 0));
    for (char& c : text)
      if (c == 'D' || c == 'd') c = 'e';
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      words_.damaged(word.line, part("there_is_where", {{"found", word.text.empty() ? "FINSF" : shown(word.text)},
                                                        {"expected", part("mail_coordinate", {{"node", shown(node)}})}}));
    return value;
  }

  static void add_name(const Words& words, Numbers& numbers, std::vector<std::string_view>& names, const Word& word,
                       Entity entity) {
    if (!numbers.emplace(word.text, static_cast<std::int32_t>(names.size())).second)
      words.damaged(word.line, entity == Entity::node ? part("node_is_there_twice", {{"node", shown(word.text)}})
                                                      : part("cell_is_there_twice", {{"cell", shown(word.text)}}));
    names.push_back(word.text);
  }

  void read_nodes(const Word& keyword) {
    const int dimension = keyword.text[5] - '0';
    if (dimension_ != 0 && dimension_ != dimension) words_.damaged(keyword.line, part("mail_both_dimensions"));
    dimension_ = dimension;
    skip_head(keyword);
    for (Word node = item(keyword); !node.text.empty(); node = item(keyword)) {
      add_name(words_, node_numbers_, nodes_, node, Entity::node);
      for (int d = 0; d < 3; ++d) coordinates_.push_back(d < dimension ? real(keyword, node.text) : 0.0);
    }
  }

  void read_cells(const Word& keyword, const catalog::CellRow& row) {
    skip_head(keyword);
    for (Word cell = item(keyword); !cell.text.empty(); cell = item(keyword)) {
      add_name(words_, cell_numbers_, cells_, cell, Entity::cell);
      types_.push_back(row.type);
      for (int j = 0; j < row.n_nodes; ++j) {
        const Word node = item(keyword);
        if (node.text.empty())
          words_.damaged(node.line, part("mail_short_cell", {{"cell", shown(cell.text)},
                                                             {"count", std::to_string(j)},
                                                             {"nodes", std::to_string(row.n_nodes)}}));
        cell_nodes_.push_back(node);
      }
    }
  }

  void read_group(const Word& keyword) {
    std::string_view name = skip_head(keyword);
    if (name.empty()) name = item(keyword).text;
    if (name.empty()) words_.damaged(words_.line(), part("mail_group_without_name"));
    if (!group_names_.emplace(keyword.text, name).second)
      words_.damaged(words_.line(),
                     part("group_is_there_twice", {{"keyword", std::string(keyword.text)}, {"group", shown(name)}}));
    Named& group = groups_.emplace_back(Named{name, keyword.text == "GROUP_NO", {}});
    for (Word member = item(keyword); !member.text.empty(); member = item(keyword)) group.members.push_back(member);
  }

  std::int32_t number(const Numbers& numbers, const Word& word, Entity entity, const std::string& where) const {
    const auto found = numbers.find(word.text);
    if (found == numbers.end())
      fail("MAIL_3", {{"file", words_.file()},
                      {"line", std::to_string(word.line)},
                      {"where", where},
                      {"what", part(entity == Entity::node ? "node" : "cell")},
                      {"name", as_utf8(std::string(word.text))}});
    return found->second;
  }

  void read_groups(std::vector<Group>& groups, bool of_nodes);
  /// Groups of one for names that are no numbers, so that they can be named; MAIL_5, or MAIL_4 where they are too many.
  void add_named(std::vector<Group>& groups, const std::vector<std::string_view>& names,
                 const std::vector<std::int32_t>& numbers, Entity entity);

  Words& words_;
  FileNames file_names_;
  int dimension_ = 0;
  std::vector<double> coordinates_;
  std::vector<std::string_view> nodes_, cells_;  ///< names, in file order
  Numbers node_numbers_, cell_numbers_;
  std::vector<CellType> types_;
  std::vector<Word> cell_nodes_;
  std::vector<Named> groups_;
  std::set<std::pair<std::string_view, std::string_view>> group_names_;  ///< keyword and name
};

/// Where the entities of a file go: by number, where their names are N1, N2, ... (or NO1, ...; M1, MA1, ... of cells) in any
/// order and no others; otherwise as the file has them.
std::vector<std::int32_t> numbers_of(const std::vector<std::string_view>& names, Entity entity) {
  std::vector<std::int32_t> numbers;
  for (const std::string_view name : names) {
    const std::optional<std::int32_t> number = number_in_name(name, entity);
    if (!number || static_cast<std::size_t>(*number) >= names.size()) break;
    numbers.push_back(*number);
  }
  std::vector<char> taken(names.size(), 0);
  const auto first_there = [&](std::int32_t n) { return std::exchange(taken[static_cast<std::size_t>(n)], 1) == 0; };
  if (numbers.size() < names.size() || !std::ranges::all_of(numbers, first_there)) {
    numbers.resize(names.size());
    std::iota(numbers.begin(), numbers.end(), 0);
  }
  return numbers;
}

Mesh MailReader::finish(std::string name) {
  if (nodes_.empty()) words_.damaged(words_.line(), part("mail_no_nodes"));
  if (cells_.empty()) words_.damaged(words_.line(), part("file_no_cells"));
  Mesh mesh;
  mesh.name = std::move(name);
  mesh.coordinates.resize(coordinates_.size());
  const std::vector<std::int32_t> node = numbers_of(nodes_, Entity::node), cell = numbers_of(cells_, Entity::cell);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    std::copy_n(coordinates_.begin() + 3 * n, 3, mesh.coordinates.begin() + 3 * node[n]);
    node_numbers_[nodes_[n]] = node[n];
  }
  std::vector<std::size_t> file_place(cells_.size()), first(1, 0);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    cell_numbers_[cells_[c]] = cell[c];
    file_place[static_cast<std::size_t>(cell[c])] = c;
    first.push_back(first.back() + static_cast<std::size_t>(catalog::cell(types_[c]).n_nodes));
  }
  std::vector<std::int32_t> own;
  for (const std::size_t c : file_place) {
    own.clear();
    for (std::size_t k = first[c]; k < first[c + 1]; ++k)
      own.push_back(
          number(node_numbers_, cell_nodes_[k], Entity::node, part("the_cell", {{"cell", as_utf8(std::string(cells_[c]))}})));
    mesh.add_cell(types_[c], own);
  }
  read_groups(mesh.cell_groups, false);
  read_groups(mesh.node_groups, true);
  add_named(mesh.cell_groups, cells_, cell, Entity::cell);
  add_named(mesh.node_groups, nodes_, node, Entity::node);
  mesh.dimension = dimension_ == 2 ? 2 : least_dimension(mesh);
  file_names_.tell(words_.file());
  return mesh;
}

void MailReader::read_groups(std::vector<Group>& groups, bool of_nodes) {
  std::map<std::string, std::vector<std::int32_t>> found;
  for (const Named& group : groups_) {
    if (group.of_nodes != of_nodes) continue;
    const std::string label = file_names_.read(std::string(group.group));
    auto& members = found[label];
    std::unordered_set<std::int32_t> known;
    for (const Word& member : group.members) {
      const std::int32_t n = number(of_nodes ? node_numbers_ : cell_numbers_, member, of_nodes ? Entity::node : Entity::cell,
                                    (of_nodes ? "GROUP_NO " : "GROUP_MA ") + label);
      if (known.insert(n).second) members.push_back(n);
    }
  }
  for (auto& [label, members] : found) groups.push_back({label, std::move(members)});
}

void MailReader::add_named(std::vector<Group>& groups, const std::vector<std::string_view>& names,
                           const std::vector<std::int32_t>& numbers, Entity entity) {
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (number_in_name(names[i], entity) != numbers[i]) own.push_back(i);
  if (own.empty()) return;
  inform(own.size() > most_names ? "MAIL_4" : "MAIL_5", {{"file", words_.file()},
                                                         {"what", part(entity == Entity::node ? "nodes" : "cells")},
                                                         {"count", std::to_string(own.size())},
                                                         {"letter", entity == Entity::node ? "N" : "M"},
                                                         {"some", as_utf8(std::string(names[own[0]]))}});
  if (own.size() > most_names) return;
  std::vector<Group> named;
  for (const std::size_t i : own) {
    const std::string label = file_names_.read(std::string(names[i]));
    if (std::ranges::find(groups, label, &Group::name) == groups.end()) named.push_back({label, {numbers[i]}});
  }
  groups.insert(groups.end(), named.begin(), named.end());
  std::ranges::sort(groups, {}, &Group::name);
}

/// A name as one word.
std::string one_word(std::string name) {
  for (char& c : name)
    if (c == ' ' || c == '\t' || c == '%' || c == '=') c = '_';
  return name;
}

/// Names of groups as words that differ: those that are words stay, others get what is free, `<word>_2` and so on.
/// @param changed lengthened by "'LOW A' -> 'LOW_A_2'"
std::vector<std::string> words_of(const std::vector<Group>& groups, std::vector<std::string>& changed) {
  std::set<std::string> taken = {"FINSF"};  // the end of a part
  for (const Group& group : groups)
    if (group.name == one_word(group.name)) taken.insert(group.name);
  std::vector<std::string> words;
  for (const Group& group : groups) {
    const bool stays = group.name == one_word(group.name) && group.name != "FINSF";
    words.push_back(stays ? group.name : free_name(one_word(group.name), [&](const std::string& word) {
      return taken.insert(word).second;
    }));
    if (!stays) changed.push_back(fmt::format("'{}' -> '{}'", group.name, words.back()));
  }
  return words;
}

/// Words in lines of eight.
void append_words(std::string& text, std::size_t count, const auto& word) {
  for (std::size_t i = 0; i < count; ++i) text += (i % 8 == 0 ? "\n " : " ") + word(i);
}

}  // namespace

Mesh read_mail_mesh(const fs::path& file) {
  first_bytes(file, 1);
  const std::string text = read_text(file);
  Words words(file.string(), text);
  MailReader reader(words);
  reader.read();
  return reader.finish(file.stem().string());
}

std::string mail_text(const Mesh& mesh, const std::string& title) {
  std::string text = "TITRE\n " + title + "\nFINSF\n" + (mesh.dimension == 2 ? "COOR_2D" : "COOR_3D");
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n) {
    text += "\n " + node_name(static_cast<std::int64_t>(n));
    for (int d = 0; d < mesh.dimension; ++d) text += fmt::format(" {:.16e}", mesh.point(n)[d]);
  }
  text += "\nFINSF\n";
  for_each_run(mesh, [&](const catalog::CellRow& row, std::size_t first, std::size_t count) {
    text += std::string(row.name);
    for (std::size_t c = first; c < first + count; ++c) {
      text += "\n " + cell_name(static_cast<std::int64_t>(c));
      const std::span<const std::int32_t> nodes = mesh.cells[c];
      for (std::size_t j = 0; j < nodes.size(); ++j) text += (j > 0 && j % 8 == 0 ? "\n  " : " ") + node_name(nodes[j]);
    }
    text += "\nFINSF\n";
  });
  std::vector<std::string> changed;
  const auto append_groups = [&](const char* keyword, const std::vector<Group>& groups, const auto& name) {
    const std::vector<std::string> words = words_of(groups, changed);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      text += std::string(keyword) + "\n " + words[g];
      append_words(text, groups[g].members.size(), [&](std::size_t i) { return name(groups[g].members[i]); });
      text += "\nFINSF\n";
    }
  };
  append_groups("GROUP_NO", mesh.node_groups, [](std::int32_t n) { return node_name(n); });
  append_groups("GROUP_MA", mesh.cell_groups, [](std::int32_t n) { return cell_name(n); });
  if (!changed.empty()) inform("MAIL_6", {{"mesh", title}, {"names", fmt::format("{}", fmt::join(changed, ", "))}});
  return text + "FIN\n";
}

}  // namespace lacon
