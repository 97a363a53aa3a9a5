#pragma once
// How each concept lies in its file, docs/structures.md section 2: a reader and a writer for each, in a file of their own.
// Tables and fields have theirs beside their data (table.hpp, field.hpp). A reader takes the root of a file of the right type,
// and throws BASE_2 where what it finds is not sound.
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/concepts.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon::storage {

Mesh read_mesh(const hdf5::Group& root);
Model read_model(const hdf5::Group& root);
Material read_material(const hdf5::Group& root);
MaterialField read_material_field(const hdf5::Group& root);
Load read_load(const hdf5::Group& root);
Contact read_contact(const hdf5::Group& root);
ElementCharacteristics read_element_characteristics(const hdf5::Group& root);
Function read_function(const hdf5::Group& root);
Formula read_formula(const hdf5::Group& root);
std::vector<double> read_list_of_reals(const hdf5::Group& root);
TimeSteps read_time_steps(const hdf5::Group& root);
Result read_result(const hdf5::Group& root);

inline constexpr std::int64_t format =
    1;  ///< of the files of a base that are written, but that of results, which has had others

/// The newest format of a type of concept: the one that is written. Earlier ones are read.
constexpr std::int64_t newest_format(std::string_view type) { return type == "result" ? 2 : format; }

/// What one of these readers makes of a file whose content may be anything. One of another format is BASE_6; what it does not
/// look at by itself (a list that is too short, JSON that is none) is BASE_2 as well.
template <class Read>
auto read_whatever(const hdf5::Group& root, const Read& read) {
  const std::int64_t found = root.has_attribute("format") ? root.integer("format") : format;
  if (const std::int64_t newest = newest_format(root.text("lacon_type")); found < format || found > newest)
    fail("BASE_6", {{"file", root.path().string()}, {"format", std::to_string(found)}, {"known", std::to_string(newest)}});
  try {
    return read(root);
  } catch (const std::logic_error& error) {  // out_of_range, length_error
    fail("BASE_2", {{"file", root.path().string()}, {"reason", part("content_does_not_fit", {{"reason", error.what()}})}});
  } catch (const nlohmann::json::exception& error) {
    fail("BASE_2", {{"file", root.path().string()}, {"reason", part("content_does_not_fit", {{"reason", error.what()}})}});
  }
}

/// What a file says of the concept itself, next to what every concept has.
void write(const hdf5::Group& root, const Mesh& mesh);
void write(const hdf5::Group& root, const Model& model);
void write(const hdf5::Group& root, const MaterialField& field);
void write(const hdf5::Group& root, const Load& load);
void write(const hdf5::Group& root, const Contact& contact);
void write(const hdf5::Group& root, const ElementCharacteristics& characteristics);
void write(const hdf5::Group& root, const Result& result);

/// Ids of the concepts that this one refers to; an empty one refers to nothing.
std::vector<std::string> references(const Mesh& mesh);
std::vector<std::string> references(const Model& model);
std::vector<std::string> references(const MaterialField& field);
std::vector<std::string> references(const Load& load);
std::vector<std::string> references(const Contact& contact);
std::vector<std::string> references(const ElementCharacteristics& characteristics);
std::vector<std::string> references(const Result& result);

}  // namespace lacon::storage
