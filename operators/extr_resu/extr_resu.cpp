#include "lacon/operators/extr_resu/extr_resu.hpp"

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/selection.hpp"

namespace lacon {

void extr_resu(const Order& order, const Base& base) {
  const Result from = base.result(order.keywords.concept_id("RESULTAT"));
  const Keywords which = order.keywords.factor("ARCHIVAGE");
  std::vector<std::int64_t> orders = selected_orders(base, from, which);
  if (which.has("PAS_ARCH"))  // and the last one
    std::erase_if(orders, [&](std::int64_t o) { return o % which.integer("PAS_ARCH") != 0 && o != from.orders.back(); });
  const std::vector<std::string> left_out = which.texts("CHAM_EXCLU");
  for (const std::string& name : left_out)
    if (!from.fields.contains(name)) {
      std::string known;
      for (const auto& [field, files] : from.fields) known += (known.empty() ? "" : ", ") + field;
      inform("EXTRRESU_1", {{"keyword", which.path("CHAM_EXCLU")}, {"name", name}, {"label", from.label}, {"known", known}});
    }
  Result to = part_of(from, orders);
  to.version = 0;
  to.label = order.result_label;
  for (const auto& [name, files] : from.fields) {
    if (std::find(left_out.begin(), left_out.end(), name) != left_out.end()) continue;
    for (const std::int64_t o : orders) {
      const auto file = files.find(o);
      if (file == files.end()) continue;
      if (order.reuse)
        to.fields[name][o] = file->second;
      else
        base.add_field(to, base.field(from, name, o));
    }
  }
  base.store(to);
}

}  // namespace lacon
