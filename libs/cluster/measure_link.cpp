// What talking costs between the first two ranks.
#include <algorithm>
#include <chrono>

#include "cluster/makespan.h"
#include "cluster/message.h"
#include "cluster/mpi_link.h"

namespace suite::cluster {

namespace {

template <class Work>
double seconds_each(int times, const Work& work) {
  const auto begun = std::chrono::steady_clock::now();
  for (int i = 0; i < times; ++i) work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() / times;
}

// One way, from the half of there and back.
double message_seconds(const Link& link, size_t bytes, int times) {
  std::vector<std::byte> buffer(bytes);
  const int n = static_cast<int>(bytes), other = 1 - link.rank();
  return 0.5 * seconds_each(times, [&] {
           for (const bool mine : {link.rank() == 0, link.rank() == 1}) {
             MPI_Request request;
             if (mine)
               MPI_Isend(buffer.data(), n, MPI_BYTE, other, 1, link.comm(), &request);
             else
               MPI_Irecv(buffer.data(), n, MPI_BYTE, other, 1, link.comm(), &request);
             MPI_Wait(&request, MPI_STATUS_IGNORE);
           }
         });
}

// Bytes/s at which the first rank unpacks results and joins them to those it has.
double take_rate() {
  const Accumulators::Shape shape{64, 16, 4, 16, false};
  const Accumulators from(shape);
  const std::vector<std::byte> packed = pack({}, from, shape.problems, kAllScrambles);
  return static_cast<double>(packed.size()) / seconds_each(2000, [&] {
           Accumulators part(shape), whole(shape);
           unpack(packed, shape.problems, kAllScrambles, part);
           whole.join(part);
         });
}

}  // namespace

LinkCosts measure(Link& link) {
  constexpr size_t kSmall = 64, kLarge = 1 << 20;
  LinkCosts costs;
  link.meet();
  double fetch = 0;
  if (link.rank() == 1) fetch = seconds_each(20000, [&] { link.fetch_and_add(1); });
  link.meet();
  if (link.rank() < 2 && link.size() > 1) {
    costs.message = message_seconds(link, kSmall, 5000);
    const double large = message_seconds(link, kLarge, 500);
    costs.rate = static_cast<double>(kLarge) / std::max(1e-9, large - costs.message);
  }
  MPI_Allreduce(&fetch, &costs.fetch, 1, MPI_DOUBLE, MPI_MAX, link.comm());
  if (link.rank() == 0) costs.take = take_rate();
  link.meet();
  return costs;
}

}  // namespace suite::cluster
