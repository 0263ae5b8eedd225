# For Spack 1.0 and later, in the folder of an unpacked distribution:
#     spack repo add contrib/spack
#     spack dev-build --test root duite@1.0.0 +hdf5
# The test is make check and make installcheck. +view wants a libepoxy with EGL: that of the system, as an external package, since Spack
# builds its own without.
from spack_repo.builtin.build_systems.autotools import AutotoolsPackage

from spack.package import *


class Duite(AutotoolsPackage):
    """Tasks that declare what they read and write, on threads and MPI ranks, and a cloth simulator on them."""

    license("BSD-3-Clause")
    version("1.0.0")

    variant("cloth", default=True, description="The cloth simulator beside the library and its tools")
    variant("hdf5", default=False, when="+cloth", description="Scientific frames")
    variant("assimp", default=False, when="+cloth", description="Meshes and figures in glTF, FBX, Collada, PLY and STL")
    variant("view", default=False, when="+cloth", description="Pictures, films and windows: duite-view")

    depends_on("c", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("uthash", type="build")
    depends_on("mpi")
    depends_on("metis@5:")
    depends_on("hwloc@2:")
    depends_on("xxhash")
    depends_on("check", type="test")
    depends_on("gmp", type="test")
    depends_on("libyaml", when="+cloth")
    depends_on("hdf5", when="+hdf5")
    depends_on("assimp@5:", when="+assimp")
    with when("+view"):
        depends_on("cairo")
        depends_on("egl")
        depends_on("glfw")
        depends_on("libepoxy")
        depends_on("libpng")

    def configure_args(self):
        args = ["MPICC=" + self.spec["mpi"].mpicc] + self.enable_or_disable("cloth")
        if self.spec.satisfies("+cloth"):
            args += self.with_or_without("assimp") + self.with_or_without("hdf5") + self.with_or_without("view") + ["--without-zmq"]
        return args
