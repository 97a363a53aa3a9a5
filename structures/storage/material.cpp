#include "lacon/structures/storage/storage.hpp"

namespace lacon::storage {

Material read_material(const hdf5::Group& root) {
  Material material;
  for (const std::string& law : root.children()) {
    const hdf5::Group group = root.open(law);
    auto& parameters = material.laws[law];
    for (const std::string& name : group.attributes()) {
      if (group.attribute_is_text(name))
        parameters[name] = group.text(name);
      else
        parameters[name] = group.real(name);
    }
  }
  return material;
}

MaterialField read_material_field(const hdf5::Group& root) {
  return {root.text("mesh"), root.text("model"), root.read_strings("materials"), root.read<std::int32_t>("cells/material")};
}

void write(const hdf5::Group& root, const MaterialField& field) {
  root.set("mesh", field.mesh);
  root.set("model", field.model);
  root.write_strings("materials", field.materials);
  root.write("cells/material", field.material);
}

std::vector<std::string> references(const MaterialField& field) {
  std::vector<std::string> references{field.mesh, field.model};
  references.insert(references.end(), field.materials.begin(), field.materials.end());
  return references;
}

}  // namespace lacon::storage
