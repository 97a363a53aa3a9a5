#include "lacon/structures/storage/storage.hpp"

#include <nlohmann/json.hpp>

namespace lacon::storage {

using nlohmann::json;

std::vector<double> read_list_of_reals(const hdf5::Group& root) { return root.read<double>("values"); }

TimeSteps read_time_steps(const hdf5::Group& root) {
  TimeSteps steps{.values = root.read<double>("values"),
                  .action = {.cut = root.integer("cut") != 0,
                             .cut_into = static_cast<int>(root.integer("cut_into")),
                             .cut_levels = static_cast<int>(root.integer("cut_levels")),
                             .smallest = root.real("smallest")},
                  .more_iterations = root.has_attribute("more_iterations") ? root.integer("more_iterations") : 0,
                  .events = {},
                  .adaptation = {}};
  if (root.has_attribute("events"))
    for (const json& event : json::parse(root.text("events")))
      steps.events.push_back({.event = event.at("event"),
                              .limit = event.at("limit"),
                              .place = event.at("place").dump(),
                              .action = {.cut = event.at("cut"),
                                         .cut_into = event.at("cut_into"),
                                         .cut_levels = event.at("cut_levels"),
                                         .smallest = event.at("smallest")}});
  if (root.has_attribute("adaptation")) {
    const json a = json::parse(root.text("adaptation"));
    steps.adaptation = StepAdaptation{.event = a.at("event"),
                                      .easy_steps = a.at("easy_steps"),
                                      .easy_iterations = a.at("easy_iterations"),
                                      .rule = a.at("rule"),
                                      .percent = a.at("percent"),
                                      .reference = a.at("reference"),
                                      .smallest = a.at("smallest"),
                                      .largest = a.at("largest"),
                                      .most = a.at("most")};
  }
  return steps;
}

}  // namespace lacon::storage
