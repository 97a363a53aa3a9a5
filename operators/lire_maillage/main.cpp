// LIRE_MAILLAGE: a mesh from a file.
#include <iostream>

#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/checks.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/formats/gmsh.hpp"
#include "lacon/structures/formats/listing.hpp"
#include "lacon/structures/formats/mail.hpp"
#include "lacon/structures/formats/med.hpp"
#include "lacon/structures/formats/text_file.hpp"

namespace {

using namespace lacon;

void read_mesh(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const std::filesystem::path file = order.unit(keywords.integer("UNITE"));
  Mesh mesh = [&] {
    const Phase phase("read");
    const std::string format = keywords.text("FORMAT");
    const bool after_pre_gmsh = format == "ASTER" && first_bytes(file, 1) == "$";
    if (format == "GMSH" || after_pre_gmsh) return read_gmsh_mesh(file);
    if (format == "ASTER") return read_mail_mesh(file);
    return read_med_mesh(file, keywords.has("NOM_MED") ? keywords.text("NOM_MED") : "");
  }();
  {
    const Phase phase("check");
    check_places(mesh);
    orient_body_cells(mesh);
    for (const Keywords& check : keywords.factors("VERI_MAIL"))
      if (check.yes("VERIF")) inspect(mesh, check.real("APLAT"));
  }
  std::cout << part("mesh_of_file", {{"label", order.result_label}, {"name", mesh.name}, {"file", file.string()}}) << '\n';
  list_mesh(std::cout, mesh, keywords.integer("INFO") > 1 || keywords.integer("INFO_MED") > 1);
  const Phase phase("write");
  base.store(mesh);
}

}  // namespace

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "lire_maillage", "Reads a mesh from a MED, gmsh or .mail file (command LIRE_MAILLAGE)",
                            read_mesh);
}
