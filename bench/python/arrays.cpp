#include "bench/python/arrays.hpp"

#define NPY_NO_DEPRECATED_API NPY_1_22_API_VERSION
#include <fmt/format.h>
#include <malloc.h>
#include <numpy/arrayobject.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace drape::bench::python {
namespace {

using solver::Vectors;

constexpr std::size_t alignment = EIGEN_MAX_ALIGN_BYTES > 16 ? EIGEN_MAX_ALIGN_BYTES : 16;

void* allocate(void*, std::size_t bytes) {
  void* memory = nullptr;
  return posix_memalign(&memory, alignment, bytes) == 0 ? memory : nullptr;
}

void* allocate_zeros(void* context, std::size_t count, std::size_t size) {
  void* memory = allocate(context, count * size);
  if (memory != nullptr) std::memset(memory, 0, count * size);
  return memory;
}

void* reallocate(void* context, void* old, std::size_t bytes) {
  void* memory = allocate(context, bytes);
  if (memory == nullptr || old == nullptr) return memory;
  std::memcpy(memory, old, std::min(bytes, malloc_usable_size(old)));
  std::free(old);
  return memory;
}

void release(void*, void* memory, std::size_t) { std::free(memory); }

PyDataMem_Handler handler = {"drape_aligned", 1, {nullptr, allocate, allocate_zeros, reallocate, release}};

/// What a matrix with a dynamic number of rows consists of.
struct Layout {
  double* data;
  Eigen::Index rows;
};
static_assert(sizeof(Layout) == sizeof(Vectors));

void set_layout(Vectors& vectors, const Layout& layout) { std::memcpy(static_cast<void*>(&vectors), &layout, sizeof layout); }

std::string shape_of(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t k = 0; k < array.ndim(); ++k) text += fmt::format("{}{}", k > 0 ? ", " : "", array.shape(k));
  return text + ")";
}

}  // namespace

void align_new_arrays() {
  if (PyArray_API == nullptr && _import_array() < 0) throw py::error_already_set();
  const auto capsule = py::reinterpret_steal<py::object>(PyCapsule_New(&handler, "mem_handler", nullptr));
  if (!capsule) throw py::error_already_set();
  const auto before = py::reinterpret_steal<py::object>(PyDataMem_SetHandler(capsule.ptr()));
  if (!before) throw py::error_already_set();
}

Borrowed::Borrowed(double* data, Eigen::Index rows) { set_layout(vectors_, {data, rows}); }

Borrowed::~Borrowed() { set_layout(vectors_, {nullptr, 0}); }

void check_borrowing() {
  alignas(alignment) double data[6] = {1, 2, 3, 4, 5, 6};
  Borrowed two(data, 2);
  const Vectors empty;
  Layout layout{data, 1};
  std::memcpy(&layout, static_cast<const void*>(&empty), sizeof layout);
  if ((*two).data() != data || (*two).rows() != 2 || (*two)(1, 2) != 6 || layout.data != nullptr || layout.rows != 0)
    throw std::runtime_error("drape: this version of Eigen keeps matrices in another way: expected Eigen 3.4");
}

bool aligned(const double* data) { return reinterpret_cast<std::uintptr_t>(data) % alignment == 0; }

double* vectors_of(py::handle object, Eigen::Index rows, const char* name, bool writeable) {
  const auto expected = [&](const std::string& found) {
    return std::invalid_argument(
        fmt::format("{}: expected an array of shape ({}, 3) and type float64, row by row (C order){}, not {}", name, rows,
                    writeable ? " and writeable" : "", found));
  };
  if (!py::isinstance<py::array>(object)) throw expected(py::str(py::type::of(object).attr("__name__")));
  const auto array = py::reinterpret_borrow<py::array>(object);
  const PyArray_Descr* type = PyArray_DESCR(reinterpret_cast<PyArrayObject*>(array.ptr()));
  if (type->type_num != NPY_DOUBLE || !PyArray_ISNBO(type->byteorder))
    throw expected(fmt::format("type {}", std::string(py::str(array.dtype()))));
  if (array.ndim() != 2 || array.shape(0) != rows || array.shape(1) != 3) throw expected("shape " + shape_of(array));
  const auto* raw = reinterpret_cast<PyArrayObject*>(array.ptr());
  if (!PyArray_IS_C_CONTIGUOUS(raw) || !PyArray_ISALIGNED(raw)) throw expected("one in another order");
  if (writeable && !array.writeable()) throw expected("one that is read-only");
  return static_cast<double*>(const_cast<void*>(array.data()));
}

py::array_t<double> new_vectors(Eigen::Index rows) { return py::array_t<double>(std::vector<py::ssize_t>{rows, 3}); }

py::array_t<double> to_array(const Vectors& vectors) {
  auto array = new_vectors(vectors.rows());
  std::memcpy(array.mutable_data(), vectors.data(), static_cast<std::size_t>(vectors.size()) * sizeof(double));
  return array;
}

}  // namespace drape::bench::python
