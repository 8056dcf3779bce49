// OpenMesh tells faults of meshes on its own streams; those that it may see are found and told before it is asked.
#pragma once

namespace suite {

// OpenMesh says nothing from now on. From any number of threads: the first use of its stream sets it up, which is not
// safe in two threads at once, so no other place may touch omerr().
void quiet_openmesh();

}  // namespace suite
