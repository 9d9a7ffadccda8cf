#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace rotrocc {

/// Threads that share the parts of a job with the one that calls: left and right image side by
/// side, or pieces of a list. They sleep between jobs, so that other nodelets of the process have
/// the processor.
class Workers {
 public:
  /// `threads` counts the calling one, and is at least 1. There are never more of them than
  /// processors.
  explicit Workers(int threads);
  ~Workers();
  Workers(Workers&&) noexcept;
  Workers& operator=(Workers&&) noexcept;

  /// Calls part(0) to part(parts - 1), each once, in any order and side by side, and returns when
  /// all are done. What a part throws is thrown here, the rest of the parts being left out; if
  /// several throw, one of it. To be called by one thread at a time, and not by a part.
  template <class Part>
  void run(int parts, Part&& part) {
    using Function = std::remove_reference_t<Part>;
    share(parts,
          {&part, [](void* function, int index) { (*static_cast<Function*>(function))(index); }});
  }

  /// Parts that a list is cut into. They differ in what they cost; more of them than threads even
  /// that out.
  static constexpr int kListParts = 8;

  /// Calls each(i, part) for all i below `count`, as run() does. `part` is below kListParts, and no
  /// two calls with the same are made at once: it tells what memory a call has to itself. Which i
  /// is of which part does not depend on the threads.
  template <class Each>
  void forEach(std::size_t count, Each&& each) {
    run(kListParts, [&](int index) {
      const auto part = static_cast<std::size_t>(index);
      const std::size_t end = count * (part + 1) / kListParts;
      for (std::size_t i = count * part / kListParts; i < end; ++i) each(i, part);
    });
  }

 private:
  /// A part(index) that is only referred to: a std::function might allocate.
  struct Job {
    void* function;
    void (*call)(void* function, int index);
  };
  class Pool;

  void share(int parts, const Job& job);

  std::unique_ptr<Pool> pool_;
};

}  // namespace rotrocc
