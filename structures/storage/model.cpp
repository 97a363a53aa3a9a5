#include "lacon/structures/storage/storage.hpp"

namespace lacon::storage {

Model read_model(const hdf5::Group& root) {
  Model model;
  model.mesh = root.text("mesh");
  model.phenomenon = root.text("phenomenon");
  model.dimension = static_cast<int>(root.integer("dimension"));
  model.elements = root.read_strings("elements");
  model.element = root.read<std::int32_t>("cells/element");
  return model;
}

void write(const hdf5::Group& root, const Model& model) {
  root.set("mesh", model.mesh);
  root.set("phenomenon", model.phenomenon);
  root.set("dimension", std::int64_t{model.dimension});
  root.write_strings("elements", model.elements);
  root.write("cells/element", model.element);
}

std::vector<std::string> references(const Model& model) { return {model.mesh}; }

}  // namespace lacon::storage
