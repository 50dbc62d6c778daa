#include "bench/studies/fabrics/fabrics.hpp"

#include "bench/studies/field/tables.hpp"

namespace drape::bench {

/// A laboratory: fabrics are stretched, sheared and bent as Kawabata's instruments do it, hang over an edge, creep under a
/// load, and are let go by all methods.
std::vector<Job> fabrics(const Question& question) {
  return {fabric_tests(), cantilevers(), creep_tests(), field_job(fabric_sheets(question.quick), question.methods)};
}

}  // namespace drape::bench
