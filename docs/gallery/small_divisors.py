"""Small divisors.

The smallest divisors that a series of order 16 has met, by the order at which they enter.
"""

from symfpu import Chain, lindstedt

chain = Chain(N=16, alpha="0.33")
series = lindstedt(chain, seeds=(1, 2), frequencies=("0.19626", "0.39046"), order=16)
print(series.smallest_divisors[0])
series.plot()
