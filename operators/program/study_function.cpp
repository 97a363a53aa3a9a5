#include "lacon/operators/program/study_function.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/program/ending.hpp"

namespace lacon {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers go over the pipe as they are in memory");

/// What a constant (DEFI_CONSTANTE) is a function of.
constexpr std::string_view any_parameter = "TOUTPARA";

/// The operator's end of the pipe to the launcher.
class FormulaPipe {
 public:
  /// Values of a formula. @param columns (parameters, n)
  static std::vector<double> ask(const std::string& id, const std::string& label, const std::vector<std::string>& parameters,
                                 std::size_t n, std::span<const double> columns) {
    const char* const descriptor = std::getenv("LACON_FORMULAS");
    if (!descriptor) fail("FORMULE_6", {{"name", label}});
    const FormulaPipe pipe(std::atoi(descriptor), label);
    pipe.send(nlohmann::json{{"formula", id}, {"parameters", parameters}, {"count", n}}.dump() + "\n");
    pipe.send({reinterpret_cast<const char*>(columns.data()), columns.size_bytes()});
    const auto answer = nlohmann::json::parse(pipe.line());
    if (const auto error = answer.find("error"); error != answer.end())
      throw Error({.severity = 'F',
                   .id = error->at("id").get<std::string>(),
                   .text = error->at("text").get<std::string>(),
                   .advice = error->at("do").get<std::string>()});
    std::vector<double> values(n);
    pipe.receive(reinterpret_cast<char*>(values.data()), n * sizeof(double));
    return values;
  }

 private:
  FormulaPipe(int socket, const std::string& label) : socket_(socket), label_(label) {}

  /// The launcher has ended, or is asked to, as this program is: it ends as by the signal that it gets for that (ending.hpp),
  /// here, where nothing is half-done.
  [[noreturn]] void give_up() const {
    if (!ending()) std::raise(SIGTERM);
    fail("FORMULE_7", {{"name", label_}});
  }

  void send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR && !ending()) continue;
      if (sent <= 0) give_up();
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
  void receive(char* bytes, std::size_t size) const {
    while (size > 0) {
      const ssize_t got = ::recv(socket_, bytes, size, 0);
      if (got < 0 && errno == EINTR && !ending()) continue;
      if (got <= 0) give_up();
      bytes += got;
      size -= static_cast<std::size_t>(got);
    }
  }
  std::string line() const {
    std::string text;
    for (char c = 0; receive(&c, 1), c != '\n';) text += c;
    return text;
  }

  int socket_;
  const std::string& label_;
};

}  // namespace

StudyFunction::StudyFunction(const Base& base, std::string_view id) : id_(id), label_(base.label(id)) {
  if (label_.empty()) label_ = id_;
  if (base.type(id) == "formula") {
    rule_ = base.formula(id);
    parameters_ = std::get<Formula>(rule_).parameters;
  } else {
    rule_ = base.function(id);
    if (const std::string& parameter = std::get<Function>(rule_).parameter; parameter != any_parameter)
      parameters_ = {parameter};
  }
}

bool StudyFunction::depends_on(std::string_view parameter) const {
  return std::find(parameters_.begin(), parameters_.end(), parameter) != parameters_.end();
}

void StudyFunction::check_parameters(std::span<const std::string_view> known, std::string_view keyword) const {
  for (const std::string& parameter : parameters_)
    if (std::find(known.begin(), known.end(), parameter) == known.end()) {
      std::string names;
      for (const std::string_view name : known) names += (names.empty() ? "" : ", ") + std::string(name);
      fail("FUNCTION_2", {{"keyword", std::string(keyword)}, {"label", label_}, {"parameter", parameter}, {"known", names}});
    }
}

std::vector<double> StudyFunction::values(std::size_t n, std::span<const ParameterValues> known) const {
  std::vector<std::string_view> names;
  for (const ParameterValues& parameter : known) names.push_back(parameter.name);
  check_parameters(names, label_);
  std::vector<std::span<const double>> columns;
  bool everywhere = true;  // one value of each parameter: one value of the function
  for (const std::string& name : parameters_) {
    columns.push_back(known[std::find(names.begin(), names.end(), name) - names.begin()].values);
    everywhere = everywhere && columns.back().size() == 1;
  }
  const std::size_t points = everywhere ? std::min<std::size_t>(n, 1) : n;
  const auto at = [&](std::size_t column, std::size_t i) { return columns[column][columns[column].size() == 1 ? 0 : i]; };
  std::vector<double> result;
  if (points == 0) return result;
  if (const Function* function = std::get_if<Function>(&rule_)) {
    for (std::size_t i = 0; i < points; ++i)
      result.push_back(columns.empty() ? function->y.front() : (*function)(at(0, i), label_));
  } else {
    std::vector<double> data;
    for (std::size_t column = 0; column < columns.size(); ++column)
      for (std::size_t i = 0; i < points; ++i) data.push_back(at(column, i));
    result = FormulaPipe::ask(id_, label_, parameters_, points, data);
  }
  if (everywhere) result.assign(n, result.front());
  return result;
}

double StudyFunction::value(std::string_view parameter, double at) const {
  const ParameterValues known{parameter, {&at, 1}};
  return values(1, {&known, 1}).front();
}

LoadValue value_of(const Base& base, const Keywords& keywords, std::string_view keyword) {
  if (!keywords.is_concept(keyword)) return {keywords.real(keyword), ""};
  const StudyFunction function(base, keywords.concept_id(keyword));
  constexpr std::string_view known[] = {"X", "Y", "Z", "INST"};
  function.check_parameters(known, keywords.path(keyword));
  return {0.0, function.id()};
}

}  // namespace lacon
