"""Area lights by linearly transformed cosines (Heitz et al. 2016): the truth, the fitter and the tables of Arealight.

Positions are in any unit of length, directions of any length but zero, radiance in W/(m^2 sr), colours linear
Rec. 709. Roughness is perceptual, alpha = roughness^2. What is wrong with an argument is a ValueError that
names it.
"""

from os import PathLike
from typing import TYPE_CHECKING, Callable, Optional, Sequence, Tuple, Union

if TYPE_CHECKING:
    import numpy

Triple = Tuple[float, float, float]
Triples = Union[Triple, Sequence[Triple], "numpy.ndarray"]
Path = Union[str, "PathLike[str]"]

__version__: str

class Light:
    """A light of constant radiance. A polygon, seen from the side that emits, runs counter-clockwise."""

    @staticmethod
    def polygon(vertices: Sequence[Triple], radiance: Triple = (1, 1, 1), two_sided: bool = False) -> "Light":
        """A flat, simple polygon of three vertices or more, convex or not."""
    @staticmethod
    def disk(
        center: Triple, axis_u: Triple, axis_v: Triple, radiance: Triple = (1, 1, 1), two_sided: bool = False
    ) -> "Light":
        """A disk or ellipse by its half axes, whose cross product points to where it shines."""
    @staticmethod
    def sphere(center: Triple, radius: float, radiance: Triple = (1, 1, 1)) -> "Light": ...
    @staticmethod
    def tube(p0: Triple, p1: Triple, radius: float, radiance: Triple = (1, 1, 1), ends: str = "round") -> "Light":
        """A cylinder or capsule; ends are 'open', 'flat' or 'round'."""

class Material:
    """A metallic-roughness material, of Lambert's lobe and GGX, added. All numbers are from 0 to 1."""

    def __init__(
        self,
        base_color: Triple = (1, 1, 1),
        metalness: float = 0.0,
        roughness: float = 0.5,
        dielectric_f0: float = 0.04,
    ) -> None: ...

class Lobe:
    """What a table holds for a roughness and a view."""

    inverse: Tuple[Triple, Triple, Triple]
    """M^-1 by rows: from the surface's frame, with the normal along z and the view in the xz plane, into cosine space."""
    schlick_inverse: Tuple[Triple, Triple, Triple]
    """That of the lobe of Schlick's weight."""
    albedo: float
    """The integral of f cos, without a Fresnel term."""
    schlick: float
    """The integral of f cos (1 - cos theta_vh)^5. With F0 the lobe reflects F0 albedo + (1 - F0) schlick."""

    def density(self, direction: Triple) -> float:
        """The density of the lobe a steradian, which integrates to 1 over the sphere."""

class Table:
    """A light table; without arguments that of GGX which is built in."""

    def __init__(self) -> None: ...
    @staticmethod
    def load(path: Path) -> "Table":
        """Read OpenEXR, KTX2 or DDS."""
    def save(self, path: Path) -> None:
        """Write OpenEXR, which `arealight table convert` makes other formats of. OSError where that is not possible."""
    @property
    def size(self) -> int:
        """Nodes a side."""
    @property
    def brdf(self) -> str: ...
    def texels(self) -> bytes:
        """The layers as the GPU has them: float32 of the shape (layers, size, size, 4)."""
    def lookup(self, roughness: float, cos_view: float) -> Lobe: ...

def radiance(
    light: Light,
    material: Material,
    view: Triples,
    position: Triples = (0, 0, 0),
    normal: Triples = (0, 0, 1),
    table: Optional[Table] = None,
) -> Triples:
    """What a surface reflects of a light to a viewer in the direction `view`, by a fitted table in float64: what the shaders compute.

    Each of view, position and normal is three numbers or an array of rows of three, all of one length; with
    rows the answer is an array of rows, too.
    """

def truth(
    light: Light,
    material: Union[Material, Callable[[Triple, Triple], float]],
    view: Triples,
    position: Triples = (0, 0, 0),
    normal: Triples = (0, 0, 1),
    tolerance: float = 1e-6,
) -> Tuple[Triples, Triples]:
    """The same by adaptive cubature of the true BRDF, and an estimate of its error, which is much larger than that.

    In place of a material, a function of view and light that returns f cos theta_light: unit vectors above
    the surface, whose normal is along z, with the view in the xz plane. A lobe that is much narrower than
    the light may be missed. What the function raises is raised.
    """

def ggx(alpha: float, view: Triple, light: Triple) -> float:
    """f cos of GGX with height-correlated masking and shadowing, a steradian, without a Fresnel term; the normal is along z."""

def fit(
    brdf: Callable[[float, Triple, Triple], float],
    size: int = 16,
    name: str = "python",
    progress: Optional[Callable[[int, int], None]] = None,
) -> Table:
    """Fit a table to a BRDF.

    brdf(alpha, view, light) is f cos theta_light, without a Fresnel term: finite and not negative. view and
    light are unit vectors above the surface, whose normal is along z; the view lies in the xz plane, 1e-4
    above the surface or more. Called about 6,000 times per node, from another thread. progress(done, steps)
    is told of every step. What either raises ends the fit, as Ctrl-C does.
    """
