"""A channel keeps what is in its band and loses what is not, however it is fed."""

import numpy as np

from symfpu.spectral.channels import HALF_WIDTH, SPAN, Channel, ChannelBank
from tests.tolerances import CHANNEL_LEAK, LINE_OF_RECORD

INTERVAL, HOP = 0.5, 40
CENTRE = 0.8


def fed(signal, pieces):
    bank = ChannelBank([Channel(0, CENTRE)], HOP, INTERVAL)
    for piece in np.array_split(signal[:, None], pieces):
        bank.feed(piece)
    return bank


def wave(frequency, n=20_000):
    return np.exp(1j * frequency * np.arange(n) * INTERVAL)


def test_pieces_do_not_matter():
    signal = wave(0.81).real
    whole, cut = fed(signal, 2).records(), fed(signal, 13).records()
    assert np.allclose(whole, cut, rtol=0, atol=LINE_OF_RECORD)


def test_a_line_in_the_band_turns_with_its_distance():
    bank = fed(wave(CENTRE + 0.01), 5)
    y = bank.records()[:, 0]
    times = bank.first_time + np.arange(len(y)) * HOP * INTERVAL
    assert np.allclose(y, bank.response(0.01) * np.exp(1j * 0.01 * times), atol=LINE_OF_RECORD)


def test_a_line_beyond_the_window_is_lost():
    beyond = 1.5 * 2 * np.pi * HALF_WIDTH / (SPAN * HOP * INTERVAL)
    assert np.abs(fed(wave(CENTRE + beyond), 5).records()).max() < CHANNEL_LEAK
    near = fed(wave(CENTRE + beyond / 4), 5).records()
    assert np.abs(near).max() > CHANNEL_LEAK
