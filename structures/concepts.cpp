#include "lacon/structures/concepts.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"

namespace lacon {

double Function::operator()(double at, std::string_view label) const {
  const double first = x.front(), last = x.back();
  // the ends of a range are met by computed instants only up to round-off
  const double slack = 1e-12 * std::max(std::abs(first), std::abs(last));
  const bool left = at<first - slack, right = at> last + slack;
  const std::string& extension = left ? extension_left : extension_right;
  if ((left || right) && extension == "EXCLU")
    fail("FUNCTION_1", {{"label", std::string(label)},
                        {"parameter", parameter},
                        {"value", fmt::format("{:.15g}", at)},
                        {"first", fmt::format("{:.15g}", first)},
                        {"last", fmt::format("{:.15g}", last)}});
  if (x.size() == 1) return y.front();
  if (((left || right) && extension == "CONSTANT") || (!left && at < first) || (!right && at > last))
    return at < first ? y.front() : y.back();
  if (interpolation[0] == "LOG" && at <= 0)
    fail("DEFI_FONCTION_9", {{"name", std::string(label)}, {"x", fmt::format("{:.15g}", at)}});
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, at);
  const auto j = static_cast<std::size_t>(above - x.begin()), i = j - 1;
  const auto scale = [](const std::string& kind, double v) { return kind == "LOG" ? std::log(v) : v; };
  const double t = (scale(interpolation[0], at) - scale(interpolation[0], x[i])) /
                   (scale(interpolation[0], x[j]) - scale(interpolation[0], x[i]));
  if (interpolation[1] == "LOG") return y[i] * std::pow(y[j] / y[i], t);
  return y[i] + t * (y[j] - y[i]);
}

const ResultStage& Result::stage(std::int64_t order) const {
  const auto later = std::find_if(stages.begin() + 1, stages.end(), [&](const ResultStage& one) { return one.first > order; });
  return *(later - 1);
}

Model Contact::completed(Model of_bodies) const {
  for (const SkinElement& skin : skins) {
    auto& names = of_bodies.elements;
    const auto at = std::find(names.begin(), names.end(), skin.element);
    of_bodies.element[static_cast<std::size_t>(skin.cell)] = static_cast<std::int32_t>(at - names.begin());
    if (at == names.end()) names.push_back(skin.element);
  }
  return of_bodies;
}

}  // namespace lacon
