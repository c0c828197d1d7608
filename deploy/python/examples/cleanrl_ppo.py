"""PPO in one file, after the manner of CleanRL, on the vector environment: three robots that share one policy.

python cleanrl_ppo.py [--seconds 60] [--envs 32] [--opponent zero:]
Needs torch. The score is printed as it grows; for real training ./vsss train is many times faster.
"""

import argparse
import time

import numpy as np
import torch
from torch import nn

import vsss


class Agent(nn.Module):
    def __init__(self, inputs: int, outputs: int) -> None:
        super().__init__()

        def net(out: int, gain: float) -> nn.Sequential:
            last = nn.Linear(64, out)
            nn.init.orthogonal_(last.weight, gain)
            return nn.Sequential(nn.Linear(inputs, 64), nn.Tanh(), nn.Linear(64, 64), nn.Tanh(), last)

        self.critic, self.mean = net(1, 1.0), net(outputs, 0.01)
        self.log_deviation = nn.Parameter(torch.full((outputs,), -0.5))

    def act(self, observation, action=None):
        spread = torch.distributions.Normal(self.mean(observation), self.log_deviation.exp())
        action = spread.sample() if action is None else action
        return action, spread.log_prob(action).sum(1), spread.entropy().sum(1), self.critic(observation).squeeze(1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--envs", type=int, default=32)
    parser.add_argument("--steps", type=int, default=64, help="decisions of each match per update")
    parser.add_argument("--opponent", default="zero:")
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    torch.manual_seed(a.seed)
    gamma, gae, clip, epochs, minibatches = 0.95, 0.95, 0.2, 4, 4

    reward = "goals,approach=1,progress=1,own_distance=0.1"
    env = vsss.make_vec(a.envs, opponent=a.opponent, observation="frame", reward=reward, episode_s=15)
    rows, inputs = env.num_envs, env.single_observation_space.shape[0]
    agent = Agent(inputs, env.single_action_space.shape[0])
    optimizer = torch.optim.Adam(agent.parameters(), lr=1e-3, eps=1e-5)
    shape = (a.steps, rows)
    obs, actions = torch.zeros(shape + (inputs,)), torch.zeros(shape + (2,))
    log_probs, rewards, values, ends, cut_values = (torch.zeros(shape) for _ in range(5))

    now = torch.tensor(env.reset(seed=a.seed)[0])  # a copy: arrays of the environment are written again
    start, update, transitions, goals, said = time.monotonic(), 0, 0, 0, []
    while time.monotonic() - start < a.seconds:
        for t in range(a.steps):
            obs[t] = now
            with torch.no_grad():
                actions[t], log_probs[t], _, values[t] = agent.act(now)
            observation, reward, terminated, truncated, infos = env.step(actions[t].numpy())
            rewards[t], ends[t] = torch.tensor(reward), torch.tensor(terminated | truncated, dtype=torch.float32)
            cut_values[t] = 0
            if truncated.any():  # the clock cut it: what came after had a value
                last = torch.tensor(np.stack([infos["final_obs"][i] for i in np.flatnonzero(truncated)]))
                with torch.no_grad():
                    cut_values[t, torch.tensor(truncated)] = agent.critic(last).squeeze(1)
            if terminated.any():
                goals += int(np.sign(infos["final_info"]["score"] @ [1, -1])[terminated].sum()) // 3
            now = torch.tensor(observation)
        with torch.no_grad():
            following, advantage, advantages = agent.critic(now).squeeze(1), torch.zeros(rows), torch.zeros(shape)
            for t in reversed(range(a.steps)):
                after = (1 - ends[t]) * following + cut_values[t]
                delta = rewards[t] + gamma * after - values[t]
                advantage = advantages[t] = delta + gamma * gae * (1 - ends[t]) * advantage
                following = values[t]
        returns = (advantages + values).flatten()
        flat = [obs.reshape(-1, inputs), actions.reshape(-1, 2), log_probs.flatten(), advantages.flatten(), returns]
        for _ in range(epochs):
            for minibatch in torch.randperm(len(returns)).chunk(minibatches):
                o, act, old, gain, target = (x[minibatch] for x in flat)
                _, new, entropy, value = agent.act(o, act)
                ratio, gain = (new - old).exp(), (gain - gain.mean()) / (gain.std() + 1e-8)
                loss = -torch.min(ratio * gain, ratio.clamp(1 - clip, 1 + clip) * gain).mean()
                loss = loss + 0.5 * (value - target).pow(2).mean() - 0.001 * entropy.mean()
                optimizer.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
                optimizer.step()
        update, transitions = update + 1, transitions + rows * a.steps
        said.append(float(rewards.mean()))
        if update % 10 == 0:
            rate = transitions / (time.monotonic() - start)
            print(f"{transitions:9d} transitions, {rate:7.0f}/s, reward {np.mean(said):+.4f}, goals {goals:+d}", flush=True)
            goals, said = 0, []
    env.close()


if __name__ == "__main__":
    main()
