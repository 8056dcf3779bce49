"""Cloud-optimised GeoTIFF: the GeoTIFF of every image in tiles, with overviews where it is large, and its header first (OGC 21-026), by GDAL's driver
COG through rasterio."""
from __future__ import annotations

import os
from pathlib import Path

from .campaign import Campaign
from .exports import images
from .text import CampaignError

TYPE = "image/tiff; application=geotiff; profile=cloud-optimized"


def check_cog(campaign: Campaign) -> None:
    """CampaignError: rasterio is not there, or images have no GeoTIFF."""
    try:
        import rasterio.shutil  # type: ignore[import-not-found,import-untyped,unused-ignore]  # noqa: F401
    except ImportError:
        raise CampaignError("the format 'cog' needs rasterio", "pip install rasterio, or other formats", str(campaign.path)) from None
    also = (campaign.simulation.get("output") or {}).get("also") or []
    if "geotiff" not in also or "image" not in campaign.keep:
        raise CampaignError("the format 'cog' needs GeoTIFFs", "`output: {also: [geotiff]}` in the simulation, and `image` among `keep`", str(campaign.path))


def write_cog(campaign: Campaign, folder: Path) -> None:
    """`cog/KEY.tif`."""
    import rasterio.shutil  # type: ignore[import-not-found,import-untyped,unused-ignore]
    (folder / "cog").mkdir(exist_ok=True)
    for image in images(folder):
        target = folder / "cog" / f"{image.key}.tif"
        if not target.exists():
            new = target.with_name(f".{target.name}.{os.getpid()}.tif")
            try:
                rasterio.shutil.copy((folder / image.file).with_suffix(".tif"), new, driver="COG", compress="deflate")
                os.replace(new, target)
            finally:
                new.unlink(missing_ok=True)
