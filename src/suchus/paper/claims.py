"""Every number and every testable statement of the article, by key."""

from collections.abc import Mapping
from types import MappingProxyType

from suchus.paper.claim import Claim
from suchus.paper.claims_body import BODY
from suchus.paper.claims_land import LAND
from suchus.paper.claims_water import WATER

CLAIMS: Mapping[str, Claim] = MappingProxyType({claim.key: claim for claim in (*BODY, *LAND, *WATER)})
"""All claims, in the article's order."""
