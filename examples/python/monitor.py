# SPDX-License-Identifier: MIT
"""A monitor of your own: print what happens to the sonars until the goal; argument: the control socket."""

import asyncio
import sys

import argus


async def main(place: str) -> None:
    """Follow the events, and the state beside them once a second."""
    async with argus.connect_async(place) as robot, asyncio.TaskGroup() as tasks:
        ticking = tasks.create_task(tick(robot))
        async for event in robot.events():
            if event.sonar is not None:
                print(f"{event.time_s:7.1f} s  sonar {event.sonar}: {event.event}")
            elif event.event in ("GOAL_REACHED", "MISSION_FAILED"):
                print(f"{event.time_s:7.1f} s  {event.event}")
                break
        ticking.cancel()


async def tick(robot: argus.AsyncRobot) -> None:
    """Print where the robot is and how many sonars it does not rely on."""
    while True:
        state = await robot.state()
        print(f"{state.time_s:7.1f} s  at {state.x_mm},{state.y_mm} mm, {len(state.failing)} failing")
        await asyncio.sleep(1.0)


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1]))
