// As threads.h says. Pipelines of three filters, of which the middle one alone is parallel.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <mutex>

#include "tests/tsan/tbb/threads.h"

namespace tbb {

enum class filter_mode { serial_in_order, parallel };

class flow_control {
 public:
  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }

 private:
  bool stopped_ = false;
};

template <class Body>
struct filter {
  Body body;
};

template <class In, class Out, class Body>
filter<Body> make_filter(filter_mode, const Body& body) {
  return {body};
}

template <class First, class Second>
struct filter_chain {
  First first;
  Second second;
};

template <class First, class Second>
filter_chain<filter<First>, filter<Second>> operator&(const filter<First>& first, const filter<Second>& second) {
  return {first, second};
}
template <class First, class Second, class Third>
filter_chain<filter_chain<First, Second>, filter<Third>> operator&(const filter_chain<First, Second>& first,
                                                                   const filter<Third>& second) {
  return {first, second};
}

template <class First, class Middle, class Last>
void parallel_pipeline(size_t at_once,
                       const filter_chain<filter_chain<filter<First>, filter<Middle>>, filter<Last>>& pipeline) {
  std::mutex taking, ending;
  std::condition_variable ended;
  flow_control flow;
  size_t taken = 0, done = 0;
  stand_in::on_threads(std::min(at_once, stand_in::concurrency()), [&] {
    for (;;) {
      std::unique_lock<std::mutex> take(taking);
      if (flow.stopped()) return;
      auto item = pipeline.first.first.body(flow);
      if (flow.stopped()) return;
      const size_t number = taken++;
      take.unlock();
      auto result = pipeline.first.second.body(item);
      std::unique_lock<std::mutex> end(ending);
      ended.wait(end, [&] { return done == number; });
      pipeline.second.body(result);
      ++done;
      ended.notify_all();
    }
  });
}

}  // namespace tbb
