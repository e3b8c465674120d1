// The columns of the table of a study.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

/// What is watched at the frames of a case.
struct Watched {
  double largest_stretch = 0.0;  ///< m
  double energy_error = 0.0;     ///< in energy scales
};

/// A case that has ended.
struct Outcome {
  const Run& run;
  const Integrator& integrator;
  const Watched& watched;
};

struct Column {
  std::string_view name;
  std::string_view unit;  ///< empty: none
  std::string_view meaning;
  std::function<std::string(const Outcome&)> text;

  std::string title() const;
};

const std::vector<Column>& allColumns();

/// \throws InputError that lists the known columns
const Column& findColumn(std::string_view name, std::string_view place);

/// The columns of a study, looked up once.
class WantedColumns {
 public:
  explicit WantedColumns(const Study& study);

  const std::vector<const Column*>& all() const { return columns_; }
  bool watchesStretch() const { return watches_stretch_; }
  bool watchesEnergy() const { return watches_energy_; }

 private:
  std::vector<const Column*> columns_;
  bool watches_stretch_ = false;
  bool watches_energy_ = false;
};

}  // namespace spring_pendulum::sweep
