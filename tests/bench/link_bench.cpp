// What ranks pay for talking to each other: mpirun -n 2 link_bench prints the four numbers that
// `dirsig-render --dry-run --ranks N --link ...` takes. On one machine it measures its memory; between nodes
// (mpirun -n 2 --map-by node) their network.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "cluster/message.h"
#include "cluster/mpi_link.h"

using namespace suite;
using namespace suite::cluster;

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
  Accumulators::Shape shape{64, 16, 4, 16, false};
  const Accumulators from(shape);
  const std::vector<std::byte> packed = pack({}, from, shape.problems, kAllScrambles);
  return static_cast<double>(packed.size()) / seconds_each(2000, [&] {
           Accumulators part(shape), whole(shape);
           unpack(packed, shape.problems, kAllScrambles, part);
           whole.join(part);
         });
}

}  // namespace

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &provided);
  {
    MPI_Comm both;
    MPI_Comm_dup(MPI_COMM_WORLD, &both);
    Link link(both);
    if (link.size() != 2) {
      std::fprintf(stderr, "link_bench: error: wants two ranks: mpirun -n 2 link_bench\n");
      MPI_Abort(MPI_COMM_WORLD, 2);
    }
    link.meet();
    const double fetch = link.rank() == 1 ? seconds_each(20000, [&] { link.fetch_and_add(1); }) : 0;
    link.meet();
    constexpr size_t kLarge = 1 << 20;
    const double small = message_seconds(link, 64, 5000), large = message_seconds(link, kLarge, 500);
    const double rate = static_cast<double>(kLarge) / std::max(1e-9, large - small);
    double fetched = 0;
    MPI_Reduce(&fetch, &fetched, 1, MPI_DOUBLE, MPI_MAX, 0, link.comm());
    if (link.rank() == 0)
      std::printf("--link %.3g,%.3g,%.3g,%.3g\n", 1e6 * fetched, 1e6 * small, 1e-9 * rate, 1e-9 * take_rate());
    link.meet();
  }
  MPI_Finalize();
}
