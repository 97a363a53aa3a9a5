#include "lacon/operators/fields/result_materials.hpp"

#include <algorithm>
#include <map>

#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/tensor.hpp"

namespace lacon {
ResultMaterials::ResultMaterials(const Base& base, const Result& result, const Mesh& mesh, ModelPoints& points)
    : base_(base), result_(result), mesh_(mesh), points_(points), field_(materials_of(base, result)) {
  MaterialTemperatures temperatures = read_temperatures(base, result.material_field, mesh);
  table_ = std::make_unique<MaterialTable>(read_materials(base, field_, temperatures));
  thermal_ = std::make_unique<ThermalMaterials>(base, field_, std::move(temperatures));
}

double ResultMaterials::elastic(std::int32_t cell, const char* name) const {
  return table_->parameter(cell, std::string("ELAS/") + name, points_.element(static_cast<std::size_t>(cell))->name);
}

template <class Matters, class Use>
void ResultMaterials::each_size(const Field& field, const Matters& matters, const Use& use) {
  std::map<std::size_t, std::pair<std::vector<std::int32_t>, std::vector<std::size_t>>> sizes;
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    if (!matters(field.support[i])) continue;
    auto& [cells, places] = sizes[field.first_row(i + 1) - field.first_row(i)];
    cells.push_back(field.support[i]);
    places.push_back(i);
  }
  for (const auto& [n_points, of_size] : sizes) use(of_size.first, of_size.second, static_cast<int>(n_points));
}

const InitialStrains& ResultMaterials::initial_strains(std::int64_t order) {
  const ResultStage& stage = result_.stage(order);
  if (!initial_ || initial_->first != stage.first) {
    initial_.emplace(stage.first, InitialStrains());
    for (const ResultLoad& load : stage.loads) initial_->second.add(base_, load, mesh_, points_);
  }
  return initial_->second;
}

std::vector<Eigen::Matrix3d> ResultMaterials::free_strains(const Field& field) {
  using Cells = std::vector<std::int32_t>;
  using Places = std::vector<std::size_t>;
  std::vector<Eigen::Matrix3d> strains(field.n_rows(), Eigen::Matrix3d::Zero());
  const auto each_row = [&](const Places& places, int n_points, const auto& use) {
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t p = 0; p < static_cast<std::size_t>(n_points); ++p)
        use(strains[field.first_row(places[i]) + p], i * static_cast<std::size_t>(n_points) + p);
  };
  const Ground ground(mesh_, points_);
  each_size(
      field, [&](std::int32_t cell) { return thermal_->concerns(cell); },
      [&](const Cells& cells, const Places& places, int n_points) {
        const std::vector<double> found = thermal_->strains(ground, field.instant, cells, n_points);
        each_row(places, n_points,
                 [&](Eigen::Matrix3d& strain, std::size_t at) { strain += found[at] * Eigen::Matrix3d::Identity(); });
      });
  const InitialStrains& initial = initial_strains(field.order);
  each_size(
      field, [&](std::int32_t cell) { return initial.concerns(cell); },
      [&](const Cells& cells, const Places& places, int n_points) {
        const std::vector<double> found = initial.at(field.instant, cells, n_points);
        each_row(places, n_points, [&](Eigen::Matrix3d& strain, std::size_t at) {
          for (std::size_t k = 0; k < tensor_axes.size(); ++k) {
            const auto& [name, i, j] = tensor_axes[k];
            strain(i, j) += found[at * tensor_axes.size() + k];
            if (i != j) strain(j, i) = strain(i, j);
          }
        });
      });
  return strains;
}

void ResultMaterials::set_strain_across(Field& strain) {
  const auto in_plane_stress = [&](std::int32_t cell) { return points_.is_plane_stress(static_cast<std::size_t>(cell)); };
  if (std::none_of(strain.support.begin(), strain.support.end(), in_plane_stress)) return;
  std::vector<double> moduli;
  for (const std::int32_t cell : strain.support)
    moduli.insert(moduli.end(), {0.0, in_plane_stress(cell) ? elastic(cell, "NU") : 0.0});  // E says nothing here
  follow_temperature(strain, moduli);
  const std::vector<Eigen::Matrix3d> free = free_strains(strain);
  const auto xx = static_cast<std::size_t>(strain.component("EPXX")), yy = static_cast<std::size_t>(strain.component("EPYY")),
             zz = static_cast<std::size_t>(strain.component("EPZZ"));
  for (std::size_t i = 0; i < strain.support.size(); ++i) {
    if (!in_plane_stress(strain.support[i])) continue;
    const double nu = moduli[2 * i + 1];  // SIZZ = 0
    for (std::size_t row = strain.first_row(i); row < strain.first_row(i + 1); ++row)
      strain.at(row, zz) =
          free[row](2, 2) - nu / (1 - nu) * (strain.at(row, xx) + strain.at(row, yy) - free[row](0, 0) - free[row](1, 1));
  }
}

std::vector<double> ResultMaterials::moduli(const Field& field) {
  std::vector<double> moduli;
  for (const std::int32_t cell : field.support) moduli.insert(moduli.end(), {elastic(cell, "E"), elastic(cell, "NU")});
  follow_temperature(field, moduli);
  return moduli;
}

void ResultMaterials::follow_temperature(const Field& field, std::vector<double>& moduli) {
  const Ground ground(mesh_, points_);
  const std::string paths[] = {"ELAS/E", "ELAS/NU"};
  each_size(
      field, [&](std::int32_t cell) { return thermal_->concerns(cell); },
      [&](const std::vector<std::int32_t>& cells, const std::vector<std::size_t>& places, int n_points) {
        if (!thermal_->has_functions(cells)) return;
        std::vector<double> constant;
        for (const std::size_t i : places) constant.insert(constant.end(), {moduli[2 * i], moduli[2 * i + 1]});
        const std::vector<double> found = thermal_->parameters(ground, field.instant, cells, n_points, paths, constant);
        for (std::size_t i = 0; i < places.size(); ++i) {
          moduli[2 * places[i]] = found[2 * i];
          moduli[2 * places[i] + 1] = found[2 * i + 1];
        }
      });
}

namespace {

Field energies_like(const Field& field, std::string name) {
  Field energy = field_like(field, std::move(name), Location::gauss_points);
  energy.quantity = "ENER_R";
  energy.components = {"TOTALE"};
  energy.support = field.support;
  energy.offset = field.offset;
  energy.present.clear();
  energy.values.assign(field.n_rows(), 0.0);
  return energy;
}

double inner(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) { return a.cwiseProduct(b).sum(); }

}  // namespace

Field energy_of_stress(const Field& stress, std::string name, ResultMaterials& materials) {
  Field energy = energies_like(stress, std::move(name));
  const std::vector<double> moduli = materials.moduli(stress);
  const TensorRows tensors(stress, "SI");
  for (std::size_t i = 0; i < stress.support.size(); ++i)
    for (std::size_t row = stress.first_row(i); row < stress.first_row(i + 1); ++row) {
      const Eigen::Matrix3d sigma = tensors[row];
      const double young = moduli[2 * i], nu = moduli[2 * i + 1];
      energy.values[row] = ((1 + nu) * inner(sigma, sigma) - nu * sigma.trace() * sigma.trace()) / (2 * young);
    }
  return energy;
}

Field energy_of_strain(const Field& strain, std::string name, ResultMaterials& materials) {
  Field energy = energies_like(strain, std::move(name));
  const std::vector<double> moduli = materials.moduli(strain);
  const std::vector<Eigen::Matrix3d> free = materials.free_strains(strain);
  const TensorRows tensors(strain, "EP");
  for (std::size_t i = 0; i < strain.support.size(); ++i)
    for (std::size_t row = strain.first_row(i); row < strain.first_row(i + 1); ++row) {
      const Eigen::Matrix3d e = tensors[row] - free[row];
      const double mu = moduli[2 * i] / (2 * (1 + moduli[2 * i + 1])),
                   lambda = 2 * mu * moduli[2 * i + 1] / (1 - 2 * moduli[2 * i + 1]);
      energy.values[row] = lambda / 2 * e.trace() * e.trace() + mu * inner(e, e);
    }
  return energy;
}

Field energy_of_path(const StateOfPoints& now, const StateOfPoints* last, const Field* before, std::string name) {
  Field energy = energies_like(now.stress, std::move(name));
  const TensorRows sigma(now.stress, "SI"), e(now.strain, "EP");
  for (std::size_t row = 0; row < energy.values.size(); ++row) {
    Eigen::Matrix3d stress = sigma[row], step = e[row];
    if (last) {
      stress += TensorRows(last->stress, "SI")[row];
      step -= TensorRows(last->strain, "EP")[row];
    }
    energy.values[row] = (before ? before->values[row] : 0.0) + inner(stress, step) / 2;
  }
  return energy;
}

Field cell_integrals(const Mesh& mesh, ModelPoints& points, const Field& density, std::string name) {
  Field sums = field_like(density, std::move(name), Location::cells);
  sums.components = density.components;
  sums.support = density.support;
  sums.offset.clear();
  sums.present.clear();
  for (std::size_t i = 0; i < density.support.size(); ++i) {
    const CellPoints& at = points(static_cast<std::size_t>(density.support[i]), mesh.coordinates);
    for (std::size_t c = 0; c < density.n_components(); ++c) {
      double sum = 0;
      for (std::size_t p = 0; p < static_cast<std::size_t>(at.n_points); ++p)
        sum += at.measure[p] * density.at(density.first_row(i) + p, c);
      sums.values.push_back(sum);
    }
  }
  return sums;
}

}  // namespace lacon
