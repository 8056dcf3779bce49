"""Campaigns: many samples of random scenes with labels, from one text (docs/guide/campaigns.md).

    from remote_scenes import campaign
    outcome = campaign.run("campaign.yaml", "dataset", workers=2)

From the command line: `python -m remote_scenes.campaign campaign.yaml -o dataset`.
"""
from .campaign import Campaign, read_campaign
from .forecast import Forecast, check_ends, forecast
from .run import Outcome, preview, run
from .text import CampaignError

__all__ = ["Campaign", "CampaignError", "Forecast", "Outcome", "check_ends", "forecast", "preview", "read_campaign", "run"]
