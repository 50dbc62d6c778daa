#pragma once

#include <omp.h>

#include <cstdint>
#include <vector>

namespace drape::base {

inline constexpr int max_threads = 64;

/// Sets how many threads large sheets may use (1 … max_threads; 1 unless set), for the whole process as OpenMP's own settings.
/// Results are the same bit for bit for any number. Throws std::invalid_argument for other numbers.
void use_threads(int threads);

/// Threads that pay for a field of this number of particles.
int threads_for(std::int64_t particles);

/// Threads that pay for a grid of this number of lines and particles, each of which takes some lines.
int threads_for_lines(int lines, std::int64_t particles);

/// Calls f(k, begin, end) for parts [begin, end) of [0, count), part k by a thread of its own. There may be fewer than
/// `threads`.
template <class F>
void in_parts(int threads, std::int64_t count, const F& f) {
  if (threads == 1) return f(0, std::int64_t{0}, count);
#pragma omp parallel num_threads(threads)
  {
    const int k = omp_get_thread_num(), parts = omp_get_num_threads();
    f(k, count * k / parts, count * (k + 1) / parts);
  }
}

/// Calls f(i) for each i of [0, count), as in_parts() shares them out.
template <class F>
void each_in_parts(int threads, std::int64_t count, const F& f) {
  in_parts(threads, count, [&](int, std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) f(i);
  });
}

/// Collects what parts of a loop find, in their order. Memory is kept from loop to loop: that of new pages takes longer than
/// what threads save.
template <class T>
class Collector {
 public:
  /// Appends to `all` what f(begin, end, part) appends to its part, for parts of [0, count). Threads take the next part when
  /// they are done with one.
  template <class F>
  void operator()(int threads, std::int64_t count, std::vector<T>& all, const F& f) {
    if (threads == 1) return f(std::int64_t{0}, count, all);
    const std::int64_t parts = std::int64_t{16} * threads;
    found_.resize(parts);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (std::int64_t k = 0; k < parts; ++k) {
      found_[k].clear();
      f(count * k / parts, count * (k + 1) / parts, found_[k]);
    }
    for (const std::vector<T>& part : found_) all.insert(all.end(), part.begin(), part.end());
  }

 private:
  std::vector<std::vector<T>> found_;
};

}  // namespace drape::base
