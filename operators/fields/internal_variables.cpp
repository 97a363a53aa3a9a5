#include "lacon/operators/fields/internal_variables.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace lacon {

bool laws_have_variables(const Base& base, const Result& result, const ResultStage& stage, Registry& registry) {
  std::vector<std::string> options;
  for (const auto& one : nlohmann::json::parse(stage.behaviour))
    options.push_back(one.at("RELATION").get<std::string>() + "/" + one.at("DEFORMATION").get<std::string>());
  if (options.empty() || result.model.empty()) return false;
  return std::ranges::any_of(base.model(result.model).elements, [&](const std::string& name) {
    const catalog::ElementRow* const element = registry.find_element(name);
    return element && std::ranges::any_of(options, [&](const std::string& option) {
             return registry.has_kernel(*element, option) &&
                    n_names(registry.kernel(*element, option, LACON_SOLID).variables) > 0;
           });
  });
}

bool laws_have_variables(const Base& base, const Result& result, Registry& registry) {
  return std::ranges::any_of(result.stages,
                             [&](const ResultStage& stage) { return laws_have_variables(base, result, stage, registry); });
}

Field zero_variables(Field stress) {
  stress.name = "VARI_ELGA";
  stress.quantity = "VARI_R";
  stress.components = {"V1"};
  stress.values.assign(stress.offset.empty() ? 0 : static_cast<std::size_t>(stress.offset.back()), 0.0);
  stress.present.clear();
  return stress;
}

}  // namespace lacon
