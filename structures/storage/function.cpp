#include "lacon/structures/storage/storage.hpp"

#include "lacon/catalog/wording.hpp"
#include "lacon/structures/storage/pieces.hpp"

namespace lacon::storage {

Function read_function(const hdf5::Group& root) {
  Function function;
  function.parameter = root.text("parameter");
  const auto interpolation = root.attribute_strings("interpolation");
  function.interpolation[0] = interpolation.at(0);
  function.interpolation[1] = interpolation.at(1);
  function.extension_left = root.text("extension_left");
  function.extension_right = root.text("extension_right");
  function.x = root.read<double>("x");
  function.y = root.read<double>("y");
  if (function.x.empty() || function.x.size() != function.y.size())
    refuse(root, part("does_not_fit", {{"what", "x"}, {"other", "y"}}));
  return function;
}

Formula read_formula(const hdf5::Group& root) { return {root.attribute_strings("parameters"), root.text("expression")}; }

}  // namespace lacon::storage
