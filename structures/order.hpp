#pragma once
// An order: one command with complete keywords, as docs/structures.md section 4 describes it.
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>  // the rest of it takes a second to compile, in each file
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/structures/vector.hpp"

namespace lacon {

/// The keywords of a command, or of one occurrence of a factor keyword. Getters throw ORDER_2 where a keyword is missing and
/// ORDER_4 where it is of another type; `path()` names the keyword in messages ("ZONE[1]/GROUP_MA_ESCL").
class Keywords {
 public:
  Keywords();
  Keywords(nlohmann::json values, std::string prefix);

  bool has(std::string_view name) const;
  double real(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  std::string text(std::string_view name) const;
  bool yes(std::string_view name) const { return text(name) == "OUI"; }
  std::vector<double> reals(std::string_view name) const;
  /// A vector of a plane or of space; throws KEYWORD_18 where it has not as many numbers as the mesh has dimensions.
  Vec3 vector(std::string_view name, int dimension) const;
  std::vector<std::int64_t> integers(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;  ///< empty where the keyword is absent
  bool is_concept(std::string_view name) const;
  std::string concept_id(std::string_view name) const;
  std::optional<double> optional_real(std::string_view name) const;
  std::optional<std::int64_t> optional_integer(std::string_view name) const;
  std::optional<std::string> optional_concept(std::string_view name) const;
  std::vector<std::string> concept_ids(std::string_view name) const;
  /// Every occurrence of a factor keyword; empty where it is absent.
  std::vector<Keywords> factors(std::string_view name) const;
  /// The one occurrence of a factor keyword whose defaults the launcher fills in. Throws KEYWORD_18 where there is another
  /// number.
  Keywords factor(std::string_view name) const;

  std::string path(std::string_view name) const { return prefix_ + std::string(name); }
  const nlohmann::json& values() const { return *values_; }

 private:
  const nlohmann::json& value(std::string_view name) const;

  std::shared_ptr<const nlohmann::json> values_;
  std::string prefix_;
};

struct Order {
  std::string command;
  std::filesystem::path base;
  std::string result_id, result_label;  ///< empty for a command without result
  bool reuse = false;
  bool resume = false;  ///< go on with a computation of this result that was ended, where its restart record is there
  std::map<int, std::filesystem::path> units;
  std::set<int> append;  ///< units whose file goes on; any other that is there is replaced
  std::vector<std::filesystem::path> plugins;
  std::string source;  ///< "study.comm:12"
  Keywords keywords;

  /// File of a unit; throws ORDER_5 where the unit has none.
  std::filesystem::path unit(std::int64_t number) const;
};

/// Read and check an order against the keyword catalogue: ORDER_1 to ORDER_4. Used by every operator.
Order read_order(const std::filesystem::path& file);
Order parse_order(const nlohmann::json& json, const std::string& file);

}  // namespace lacon
