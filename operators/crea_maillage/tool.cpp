#include "lacon/operators/crea_maillage/tool.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/crea_maillage/crea_maillage.hpp"
#include "lacon/operators/meshing/checks.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/files.hpp"
#include "lacon/structures/formats/med.hpp"

namespace lacon {

namespace fs = std::filesystem;

int cut_med_file(int argc, char** argv) {
  CLI::App app{"Cuts the slave skins of a mesh, and the cells under them, into macro-elements for LAC contact.",
               "crea_maillage"};
  app.footer(
      "Groups and the mesh's name stay; fields and other meshes of IN do not go into OUT.\n"
      "With an order, crea_maillage order.json, it runs the command CREA_MAILLAGE (docs/structures.md, section 4).");
  fs::path in, out;
  std::string name;
  bool keep_node_groups = false;
  LacCut cut{.node_groups = SkinGroups::complete, .keyword = "--slave"};
  app.add_option("IN", in, "MED file with the mesh")->required();
  app.add_option("OUT", out, "MED file to write; replaced if it is there")->required();
  app.add_option("--slave", cut.groups, "group of cells: a slave skin. Several: the option again; each is one contact zone")
      ->required()
      ->allow_extra_args(false);
  app.add_option("--hexa", cut.option, "hexahedra become pyramids (PYRA) or hexahedra (HEXA)")
      ->check(CLI::IsMember({"PYRA", "HEXA"}))
      ->capture_default_str();
  app.add_option("--mesh", name, "name of the mesh in IN; otherwise the first");
  app.add_flag("--keep-node-groups", keep_node_groups,
               "groups of nodes stay as they are; otherwise those that hold a whole slave skin get its new nodes");
  app.add_flag("--quality", cut.details, "print quantiles of the cells' quality, and the worst cells");
  return run_tool(argc, argv, app, [&] {
    std::error_code error;
    if (fs::equivalent(in, out, error)) fail("CUT_1", {{"file", in.string()}});
    check_replaceable(out);  // before the work
    if (keep_node_groups) cut.node_groups = SkinGroups::keep;
    const Mesh made = [&] {
      Mesh mesh = [&] {
        const Phase phase("read");
        return read_med_mesh(in, name);
      }();
      fmt::print("Mesh '{}' of {}\n", mesh.name, in.string());
      const Phase phase("cut");
      turn_body_cells(mesh);
      return cut_and_tell(std::move(mesh), cut);
    }();
    const Phase phase("write");
    write_med(out, false, [&](MedFile& med) { med.add_mesh(made, made.name); });
    fmt::print("written: {}\n", out.string());
  });
}

}  // namespace lacon
