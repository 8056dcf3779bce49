#include "scheduler/items.h"

#include <algorithm>
#include <map>

#include "scheduler/moments.h"

namespace suite {

std::vector<Item> items_of(std::span<const std::unique_ptr<Sensor>> sensors, bool moves) {
  std::vector<Item> items;
  std::map<std::pair<double, double>, size_t> windows;
  StateNumbers numbers;
  for (size_t s = 0; s < sensors.size(); ++s) {
    std::vector<size_t> number;  // of each of the sensor's states
    for (const SpectralState& state : sensors[s]->states()) number.push_back(numbers.of(state));
    for (size_t t = 0; t < sensors[s]->tasks().size(); ++t)
      for (size_t c = 0; c < sensors[s]->tasks()[t].captures.size(); ++c) {
        const Capture& capture = sensors[s]->tasks()[t].captures[c];
        const size_t window =
            moves ? windows.try_emplace({capture.window.begin, capture.window.end}, windows.size()).first->second : 0;
        items.push_back({s, t, c, items.size(), {window, number[capture.state]}, moment_of(capture)});
      }
  }
  return items;
}

std::vector<Item> in_cheapest_order(const std::vector<Item>& items, bool dated, size_t& changes) {
  std::vector<StatePair> pairs;
  for (const Item& i : items) pairs.push_back(i.state);
  std::vector<Item> ordered;
  std::vector<StatePair> sequence;
  for (const size_t i : cheapest_order(pairs)) ordered.push_back(items[i]), sequence.push_back(items[i].state);
  changes = state_changes(sequence);
  for (auto run = ordered.begin(); dated && run != ordered.end();) {
    const auto end = std::find_if(run, ordered.end(), [&](const Item& i) { return !(i.state == run->state); });
    std::stable_sort(run, end, [](const Item& a, const Item& b) { return a.moment < b.moment; });
    run = end;
  }
  return ordered;
}

}  // namespace suite
