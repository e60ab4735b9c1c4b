# SPDX-License-Identifier: Apache-2.0
"""Inserts a battery box by what is felt: the Gymnasium environment volcontact/ORUInsertion-v0.

./run python python/examples/insert_oru.py
"""

import gymnasium

from volcontact.gym import ENV_ID, ForceGuided


def main() -> None:
    """Runs one episode of the scripted policy and prints how it ends."""
    env = gymnasium.make(ENV_ID)
    policy = ForceGuided()
    observation, info = env.reset(seed=1)
    ended, steps = False, 0
    while not ended:
        observation, _, terminated, truncated, info = env.step(policy(observation))
        ended, steps = terminated or truncated, steps + 1
    env.close()
    print(f"{'seated' if info['is_success'] else 'not seated'} after {0.1 * steps:.1f} s")
    print(f"at the grasp up to {info['peak_force']:.1f} N and {info['peak_torque']:.1f} N m")
    print(f"{1e3 * info['distance']:.4f} mm and {info['angle']:.5f} degrees from the seat")


if __name__ == "__main__":
    main()
