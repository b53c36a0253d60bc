"""Short families that several tests follow."""

from functools import lru_cache

from symfpu import Chain, family

ROUND = Chain(8, alpha="0.4", beta="0.1")

RUNS = {
    "breather": ((ROUND, (3,), "0.1"), {"multipliers": True, "from_energy": "0.001"}),
    "pair": ((Chain(6, beta="0.3"), (1, 3), "0.01"), {"from_energy": "0.002", "tolerance": 1e-10}),
    "appendix-a": ((ROUND, (1, 3), "0.01"), {"method": "appendix-a", "order": 4, "from_energy": "0.002"}),
}


@lru_cache
def whole(run):
    arguments, options = RUNS[run]
    return family(*arguments, **options)
