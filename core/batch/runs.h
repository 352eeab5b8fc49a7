// Runs of lanes that are alike.
#pragma once

namespace whit {

/// Calls body(first, last) for every longest run of lanes [first, last) within [begin, end) that have the same key_of(lane).
template <class KeyOf, class Body>
inline void for_runs(int begin, int end, const KeyOf& key_of, const Body& body) {
  for (int first = begin, last; first < end; first = last) {
    const auto key = key_of(first);
    for (last = first + 1; last < end && key_of(last) == key;) ++last;
    body(first, last);
  }
}

}  // namespace whit
