// Plug-ins: found, checked and refused with the file's name.
#include "lacon/elements/registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>

#include "lacon/catalog/messages.hpp"

namespace {

namespace fs = std::filesystem;
using lacon::Registry;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A folder for plug-ins that goes away at the end.
struct Plugins : testing::Test {
  fs::path folder = fs::temp_directory_path() / ("lacon_plugins_" + std::to_string(::getpid()));

  Plugins() { fs::create_directories(folder); }
  ~Plugins() override {
    ::unsetenv("LACON_PLUGIN_PATH");
    fs::remove_all(folder);
  }

  fs::path write(const std::string& name, const std::string& rows) {
    fs::create_directories(folder / name);
    std::ofstream(folder / name / "plugin.toml") << rows;
    return folder / name;
  }
  /// Put the test library `library` (of broken.cpp) in the folder of the plug-in `name`.
  void place_library(const std::string& name, const std::string& library) {
    fs::create_directories(folder / name);
    fs::copy_file(fs::path(LACON_BINARY_DIR) / "tests" / "broken" / ("lib" + library + ".so"),
                  folder / name / ("lib" + name + ".so"));
  }
};

/// The message of the error that `action` raises.
lacon::Message message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const lacon::Error& error) {
    return error.message();
  }
  ADD_FAILURE() << "no error";
  return {};
}

/// A row of a plug-in, with `changed` in place of the line that starts so.
std::string row(const std::string& key = "", const std::string& changed = "") {
  const std::pair<std::string, std::string> lines[] = {
      {"modelisation", "modelisation = 'D_TEST'"},
      {"phenomenon", "phenomenon = 'MECANIQUE'"},
      {"role", "role = 'solid'"},
      {"geometry", "geometry = 'plane'"},
      {"stress_state", "stress_state = 'plane_strain'"},
      {"points", "points = { TRIA3 = 1, QUAD4 = 4 }"},
      {"dofs", "dofs = ['DX', 'DY']"},
      {"stress", "stress = ['SIXX', 'SIYY', 'SIZZ', 'SIXY']"},
      {"kernels", "kernels = { 'ELAS/PETIT' = 'solid/plane_strain_small_elastic' }"}};
  std::string text = "[[element]]\n";
  for (const auto& [name, line] : lines) text += (name == key ? changed : line) + "\n";
  return text;
}

TEST_F(Plugins, EveryKernelOfTheCatalogueExists) {
  Registry registry;
  int kernels = 0;
  for (const auto& element : lacon::catalog::elements()) {
    EXPECT_EQ(registry.find_element(element.name), &element);
    EXPECT_EQ(registry.find_element(element.modelisation, element.cell), &element);
    for (const auto& option : element.kernels) {
      const auto kind = option.option.find('/') != std::string_view::npos ? LACON_SOLID
                        : option.option == "RIGI_CONT"                    ? LACON_CONTACT
                                                                          : LACON_LOAD;
      const lacon_kernel& kernel = registry.kernel(element, option.option, kind);
      EXPECT_TRUE(std::string(option.kernel).ends_with(std::string("/") + kernel.name)) << element.name;
      EXPECT_TRUE(registry.has_kernel(element, option.option));
      ++kernels;
    }
  }
  EXPECT_GE(kernels, 9);
  EXPECT_THAT(registry.modelisations(), testing::Contains("D_PLAN"));
}

TEST_F(Plugins, SolidKernelSaysWhichParametersItTakes) {
  Registry registry;
  const auto& kernel = registry.kernel(*registry.find_element("D_PLAN/TRIA3"), "ELAS/PETIT", LACON_SOLID);
  ASSERT_STREQ(kernel.parameters[0], "ELAS/E");
  ASSERT_STREQ(kernel.parameters[1], "ELAS/NU");
  EXPECT_EQ(kernel.parameters[2], nullptr);
}

TEST_F(Plugins, WhatDoesNotExistIsNotFound) {
  Registry registry;
  EXPECT_EQ(registry.find_element("D_PLAN/PYRAM5"), nullptr);
  EXPECT_EQ(registry.find_element("NO_PLAN", lacon::CellType::TRIA3), nullptr);
  EXPECT_FALSE(registry.has_kernel(*registry.find_element("D_PLAN/TRIA3"), "RIGI_CONT"));
}

TEST_F(Plugins, AnOptionWithoutKernelOrOfAnotherKindIsRefused) {
  Registry registry;
  const auto& solid = *registry.find_element("D_PLAN/TRIA3");
  lacon::Message message = message_of([&] { registry.kernel(solid, "RIGI_CONT", LACON_CONTACT); });
  EXPECT_EQ(message.id, "PLUGIN_3");
  EXPECT_THAT(message.text, AllOf(HasSubstr("D_PLAN/TRIA3"), HasSubstr("RIGI_CONT")));
  message = message_of([&] { registry.kernel(solid, "ELAS/PETIT", LACON_LOAD); });
  EXPECT_EQ(message.id, "PLUGIN_3");
  EXPECT_THAT(message.text, AllOf(HasSubstr("libsolid.so"), HasSubstr("solid elements")));
}

TEST_F(Plugins, RowsOfAPluginServeItsCells) {
  const fs::path plugin = write("test_rows", row());
  Registry registry(std::vector{plugin});
  const auto* element = registry.find_element("D_TEST", lacon::CellType::QUAD4);
  ASSERT_NE(element, nullptr);
  EXPECT_EQ(element->name, "D_TEST/QUAD4");
  EXPECT_EQ(element->points, 4);
  EXPECT_EQ(element->role, lacon::catalog::Role::solid);
  EXPECT_EQ(element->geometry, lacon::catalog::Geometry::plane);
  EXPECT_EQ(element->stress_state, lacon::catalog::StressState::plane_strain);
  EXPECT_THAT(element->dofs, ElementsAre("DX", "DY"));
  EXPECT_THAT(element->stress, ElementsAre("SIXX", "SIYY", "SIZZ", "SIXY"));
  EXPECT_STREQ(registry.kernel(*element, "ELAS/PETIT", LACON_SOLID).name, "plane_strain_small_elastic");
  EXPECT_THAT(registry.modelisations(), testing::IsSupersetOf({"D_PLAN", "D_TEST"}));
}

TEST_F(Plugins, AreFoundOnThePathAlsoInAFolderOfSeveral) {
  write("test_one", row());
  write("test_two", row("modelisation", "modelisation = 'D_TWO'"));
  ::setenv("LACON_PLUGIN_PATH", folder.c_str(), 1);
  {
    Registry registry;
    EXPECT_NE(registry.find_element("D_TEST/TRIA3"), nullptr);
    EXPECT_NE(registry.find_element("D_TWO/TRIA3"), nullptr);
  }
  const std::string path = (folder / "test_one").string() + "/::" + (folder / "test_two").string();
  ::setenv("LACON_PLUGIN_PATH", path.c_str(), 1);
  Registry registry(std::vector{folder / "test_two"});  // the same one twice is one
  EXPECT_NE(registry.find_element("D_TEST/TRIA3"), nullptr);
  EXPECT_NE(registry.find_element("D_TWO/TRIA3"), nullptr);
}

TEST_F(Plugins, AFolderThatHoldsNoneIsRefused) {
  for (const fs::path& bad : {folder, folder / "missing"}) {
    ::unsetenv("LACON_PLUGIN_PATH");
    const auto from_order = message_of([&] { Registry registry(std::vector{bad}); });
    ::setenv("LACON_PLUGIN_PATH", bad.c_str(), 1);
    const auto from_path = message_of([&] { Registry registry; });
    for (const auto& message : {from_order, from_path}) {
      EXPECT_EQ(message.id, "PLUGIN_1");
      EXPECT_THAT(message.text, HasSubstr(bad.string()));
    }
  }
}

TEST_F(Plugins, TwoOfOneNameAreRefused) {
  const fs::path plugin = write("solid", row());
  const auto message = message_of([&] { Registry registry(std::vector{plugin}); });
  EXPECT_EQ(message.id, "PLUGIN_1");
  EXPECT_THAT(message.text, HasSubstr("another plug-in of this name"));
}

TEST_F(Plugins, BadRowsAreRefusedWithFileElementAndReason) {
  struct Case {
    std::string rows, id, reason;
  };
  const Case cases[] = {
      {"[[element", "PLUGIN_1", "line 1"},
      {"element = 3", "PLUGIN_1", "'element' is not a list"},
      {"[cell]\nname = 'x'", "PLUGIN_1", "'cell' is not a list"},
      {row("modelisation"), "PLUGIN_2", "element in line 1: it lacks the text 'modelisation'"},
      {row("role", "role = 'shell'"), "PLUGIN_2", "its role 'shell' is none of 'solid', 'skin'"},
      {row("geometry"), "PLUGIN_2", "it lacks the text 'geometry'"},
      {row("geometry", "geometry = 'sphere'"), "PLUGIN_2", "its geometry 'sphere' is none of 'plane', 'axis', 'space'"},
      {row("geometry", "geometry = 'space'"), "PLUGIN_2", "it has a 'stress_state', which solids in the plane alone have"},
      {row("stress_state"), "PLUGIN_2", "it lacks the text 'stress_state'"},
      {row("stress_state", "stress_state = 'flat'"), "PLUGIN_2", "'flat' is none of 'plane_strain', 'plane_stress'"},
      {row("points", "points = { HEXA8 = 8 }"), "PLUGIN_2",
       "D_TEST/HEXA8: a cell of this dimension is no solid of its geometry"},
      {row("points"), "PLUGIN_2", "'points'"},
      {row("points", "points = {}"), "PLUGIN_2", "'points'"},
      {row("points", "points = { TRIA7 = 1 }"), "PLUGIN_2", "D_TEST/TRIA7: the cell 'TRIA7' does not exist"},
      {row("points", "points = { TRIA3 = 2 }"), "PLUGIN_2", "no integration rule of 2 points"},
      {row("points", "points = { TRIA3 = -1 }"), "PLUGIN_2", "no integration rule of -1 points"},
      {row("points", "points = { TRIA3 = 99999999999 }"), "PLUGIN_2", "no integration rule"},
      {row("points", "points = { TRIA3 = 'x' }"), "PLUGIN_2", "no integration rule"},
      {row("dofs"), "PLUGIN_2", "'dofs'"},
      {row("dofs", "dofs = ['DX', 3]"), "PLUGIN_2", "'dofs' names ''"},
      {row("dofs", "dofs = ['DX', 'DW']"), "PLUGIN_2", "'DW', which is no component of DEPL_R"},
      {row("dofs", "dofs = ['DX', 'DX']"), "PLUGIN_2", "'DX' twice"},
      {row("dofs", "dofs = ['DY', 'DX']"), "PLUGIN_2", "its geometry, 'DX', 'DY', in this order"},
      {row("dofs", "dofs = ['DX']"), "PLUGIN_2", "its geometry, 'DX', 'DY', in this order"},
      {row("dofs", "dofs = ['TEMP', 'DX', 'DY']"), "PLUGIN_2", "its geometry, 'DX', 'DY', in this order"},
      {row("dofs", "dofs = ['DX', 'DY', 'DZ']"), "PLUGIN_2", "'DZ', which is no unknown of elements of its geometry"},
      {row("dofs", "dofs = ['DX', 'DY', 'LAGS_C']"), "PLUGIN_2", "'LAGS_C', which is no unknown of elements"},
      {row("stress", "stress = ['SIWW']"), "PLUGIN_2", "'SIWW', which is no component of SIEF_R"},
      {row("kernels"), "PLUGIN_2", "'kernels'"},
      {row("kernels", "kernels = { 'ELAS/PETIT' = 'solid' }"), "PLUGIN_2", "'plug-in/kernel'"},
      {row("kernels", "kernels = { 'ELAS/PETIT' = 'nowhere/x' }"), "PLUGIN_2", "'nowhere', which was not found"},
      {row() + "colour = 'blue'\n", "PLUGIN_2", "the key 'colour'"},
      {row() + row(), "PLUGIN_2", "another row has this name"},
      {row("modelisation", "modelisation = 'D_PLAN'"), "PLUGIN_2", "D_PLAN/QUAD4: another row has this name"},
  };
  for (const Case& c : cases) {
    const fs::path plugin = write("test_bad", c.rows);
    const auto message = message_of([&] { Registry registry(std::vector{plugin}); });
    EXPECT_EQ(message.id, c.id) << c.rows;
    EXPECT_THAT(message.text, AllOf(HasSubstr((plugin / "plugin.toml").string()), HasSubstr(c.reason))) << c.rows;
  }
}

/// A law that a plug-in brings for a built-in modelisation, with `changed` in place of the line that starts so.
std::string law(const std::string& key = "", const std::string& changed = "") {
  const std::pair<std::string, std::string> lines[] = {
      {"[[relation]]", "[[relation]]"},
      {"name", "name = 'SOFT'"},
      {"help", "help = 'a soft law'"},
      {"hardening", "hardening = 'TRACTION'"},
      {"transverse_strain", "transverse_strain = 'elastic'"},
      {"starts_elastically", "starts_elastically = true"},
      {"[[deformation]]", "[[deformation]]"},
      {"name_of_deformation", "name = 'LARGE'"},
      {"help_of_deformation", "help = 'large strains'"},
      {"stress_geometry", "stress_geometry = 'displaced'"},
      {"strain", "strain = 'green_lagrange'"},
      {"plastic_strain", "plastic_strain = 'logarithmic'"},
      {"adds_stress", "adds_stress = true"},
      {"turns_stress", "turns_stress = true"},
      {"[[law]]", "[[law]]"},
      {"relation", "relation = 'SOFT'"},
      {"deformation", "deformation = 'LARGE'"},
      {"kernels", "kernels = { D_PLAN = 'solid/plane_strain_green_elastic' }"}};
  std::string text;
  for (const auto& [name, line] : lines) text += (name == key ? changed : line) + "\n";
  return text;
}

TEST_F(Plugins, LawsOfAPluginServeTheBodiesOfAModelisation) {
  Registry registry(std::vector{write("test_law", law() + "[material.SOFT]\ntype = 'factor'\n")});
  const auto* relation = registry.find_relation("SOFT");
  ASSERT_NE(relation, nullptr);
  EXPECT_EQ(relation->hardening, "TRACTION");
  EXPECT_EQ(relation->transverse_strain, lacon::catalog::TransverseStrain::elastic);
  EXPECT_TRUE(relation->starts_elastically);
  const auto* deformation = registry.find_deformation("LARGE");
  ASSERT_NE(deformation, nullptr);
  EXPECT_EQ(deformation->stress_geometry, lacon::catalog::StressGeometry::displaced);
  EXPECT_EQ(deformation->strain, lacon::catalog::StrainMeasure::green_lagrange);
  EXPECT_EQ(deformation->plastic_strain, lacon::catalog::PlasticStrain::logarithmic);
  EXPECT_TRUE(deformation->adds_stress);
  EXPECT_TRUE(deformation->turns_stress);
  for (const char* body : {"D_PLAN/TRIA3", "D_PLAN/QUAD9"})
    EXPECT_STREQ(registry.kernel(*registry.find_element(body), "SOFT/LARGE", LACON_SOLID).name, "plane_strain_green_elastic");
  EXPECT_FALSE(registry.has_kernel(*registry.find_element("D_PLAN/SEG2"), "SOFT/LARGE"));
  EXPECT_FALSE(registry.has_kernel(*registry.find_element("C_PLAN/TRIA3"), "SOFT/LARGE"));
  EXPECT_EQ(registry.find_relation("HARD"), nullptr);
  EXPECT_EQ(registry.find_deformation("SOFT"), nullptr);
  for (const auto& built_in : lacon::catalog::elements())
    for (const auto& kernel : built_in.kernels)
      if (const std::size_t slash = kernel.option.find('/'); slash != std::string_view::npos) {
        EXPECT_NE(registry.find_relation(kernel.option.substr(0, slash)), nullptr) << kernel.option;
        EXPECT_NE(registry.find_deformation(kernel.option.substr(slash + 1)), nullptr) << kernel.option;
      }
}

TEST_F(Plugins, BadLawsAreRefusedWithFileAndReason) {
  const std::pair<std::string, std::string> cases[] = {
      {law("name"), "relation in line 1: it lacks the text 'name'"},
      {law("help"), "relation SOFT: it lacks the text 'help'"},
      {law("name", "name = 'ELAS'"), "relation ELAS: another row has this name"},
      {law("transverse_strain", "transverse_strain = 'none'"), "'none' is none of 'elastic', 'isochoric'"},
      {law("starts_elastically", "starts_elastically = 'yes'"),
       "relation SOFT: its 'starts_elastically' is neither true nor false"},
      {law("plastic_strain", "plastic_strain = 'none'"),
       "'none' is none of 'small', 'green_lagrange', 'logarithmic', 'stretches'"},
      {law("name_of_deformation", "name = 'PETIT'"), "deformation PETIT: another row has this name"},
      {law("stress_geometry"), "deformation LARGE: it lacks the text 'stress_geometry'"},
      {law("strain", "strain = 'huge'"), "'huge' is none of 'small', 'green_lagrange'"},
      {law("relation", "relation = 'HARD'"), "law HARD/LARGE: there is no relation 'HARD'"},
      {law("deformation", "deformation = 'HUGE'"), "law SOFT/HUGE: there is no deformation 'HUGE'"},
      {law("kernels"), "law SOFT/LARGE: it lacks the table 'kernels' (modelisation"},
      {law("kernels", "kernels = { D_NONE = 'solid/x' }"), "there is no modelisation 'D_NONE'"},
      {law("kernels", "kernels = { D_PLAN = 'nowhere/x' }"), "'nowhere', which was not found"},
      {law() + "[[law]]\nrelation = 'ELAS'\ndeformation = 'PETIT'\nkernels = { D_PLAN = 'solid/x' }\n",
       "law ELAS/PETIT: 'D_PLAN' has a kernel for it already"},
      {row("kernels", "kernels = { 'SOFT/PETIT' = 'solid/plane_strain_small_elastic' }"),
       "its option 'SOFT/PETIT' names no behaviour: there is no relation 'SOFT'"},
  };
  for (const auto& [rows, reason] : cases) {
    const fs::path plugin = write("test_bad", rows);
    const auto message = message_of([&] { Registry registry(std::vector{plugin}); });
    EXPECT_EQ(message.id, "PLUGIN_2") << rows;
    EXPECT_THAT(message.text, AllOf(HasSubstr((plugin / "plugin.toml").string()), HasSubstr(reason))) << rows;
  }
}

TEST_F(Plugins, BadLibrariesAreRefusedWithTheirFileWhenAKernelIsAskedFor) {
  const std::pair<std::string, std::string> cases[] = {
      {"broken_no_entry", "no function lacon_plugin"},
      {"broken_null", "returns nothing"},
      {"broken_abi", "interface (ABI) 77"},
      {"broken_sizes", "other sizes"},
      {"broken_empty", "has no kernels"},
      {"broken_unnamed", "has no name"},
      {"broken_no_function", "'k' has no function"},
      {"broken_kind", "of the unknown kind 9"},
      {"broken_parameters", "no list of parameters"},
      {"broken_symbol", "undefined symbol"},
      {"broken_twice", "'k' names the unknown 'DX' twice"},
  };
  for (const auto& [name, reason] : cases) {
    const fs::path plugin = write(name, row("kernels", "kernels = { 'ELAS/PETIT' = '" + name + "/k' }"));
    place_library(name, name);
    Registry registry(std::vector{plugin});  // what nobody uses does no harm
    const auto message =
        message_of([&] { registry.kernel(*registry.find_element("D_TEST/TRIA3"), "ELAS/PETIT", LACON_SOLID); });
    EXPECT_EQ(message.id, "PLUGIN_1") << name;
    EXPECT_THAT(message.text, AllOf(HasSubstr((plugin / ("lib" + name + ".so")).string()), HasSubstr(reason))) << name;
  }
}

TEST_F(Plugins, AKernelWorksOnUnknownsOfItsElement) {
  const std::string kernels =
      "kernels = { 'ELAS/PETIT' = 'broken_foreign/k', 'ELAS/PETIT_REAC' = 'solid/plane_strain_updated_elastic' }";
  fs::path plugin = write("broken_foreign", row("kernels", kernels));
  place_library("broken_foreign", "broken_foreign");
  {
    Registry registry(std::vector{plugin});
    const auto message =
        message_of([&] { registry.kernel(*registry.find_element("D_TEST/TRIA3"), "ELAS/PETIT", LACON_SOLID); });
    EXPECT_EQ(message.id, "PLUGIN_3");
    EXPECT_THAT(message.text,
                AllOf(HasSubstr("libbroken_foreign.so"), HasSubstr("'TEMP', which is none of the element's 'dofs'")));
  }
  std::string wide = row("kernels", kernels);
  wide.replace(wide.find("'DY']"), 5, "'DY', 'PSI', 'TEMP']");
  plugin = write("broken_foreign", wide);
  Registry registry(std::vector{plugin});
  const auto& element = *registry.find_element("D_TEST/TRIA3");
  EXPECT_THAT(lacon::unknowns_of(element, registry.kernel(element, "ELAS/PETIT", LACON_SOLID)),
              ElementsAre("DX", "DY", "TEMP"));
  EXPECT_THAT(lacon::unknowns_of(element, registry.kernel(element, "ELAS/PETIT_REAC", LACON_SOLID)), ElementsAre("DX", "DY"));
}

TEST_F(Plugins, AMissingOrUnreadableLibraryOrKernelIsRefusedWithTheFile) {
  fs::path plugin = write("empty_one", row("kernels", "kernels = { 'ELAS/PETIT' = 'empty_one/k' }"));
  const auto ask = [&] {
    Registry registry(std::vector{plugin});
    registry.kernel(*registry.find_element("D_TEST/TRIA3"), "ELAS/PETIT", LACON_SOLID);
  };
  EXPECT_THAT(message_of(ask).text, AllOf(HasSubstr("libempty_one.so"), HasSubstr("No such file")));
  std::ofstream(plugin / "libempty_one.so") << "not a library";
  EXPECT_THAT(message_of(ask).text, AllOf(HasSubstr("libempty_one.so"), HasSubstr("too short")));
  plugin = write("test_rows", row("kernels", "kernels = { 'ELAS/PETIT' = 'solid/plane_stress' }"));
  const auto message = message_of(ask);
  EXPECT_EQ(message.id, "PLUGIN_3");
  EXPECT_THAT(message.text, AllOf(HasSubstr("libsolid.so"), HasSubstr("'plane_stress'"), HasSubstr("D_TEST/TRIA3")));
}

}  // namespace
