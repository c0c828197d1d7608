"""Self-play on EnvPool's soccer with that learner: all six players of 32 matches learn one policy; one core, five epochs."""
import time

import torch

from ppo import Learner
from soccer import Soccer
from timing import say

STEPS, EPOCHS, MINIBATCH, GAMMA, LAMBDA = 64, 5, 2048, 0.99, 0.95
soccer = Soccer(32, 20.0)
x = torch.as_tensor(soccer.reset())
learner = Learner(x.shape[1], soccer.space.shape[0], beta=False)


def collect():
    global x
    rows = []
    with torch.no_grad():
        for _ in range(STEPS):
            d = learner.distribution(x)
            action = d.sample()
            seen, reward, done = soccer.step(action.clamp(-1, 1).numpy())
            rows.append((x, action, d.log_prob(action).sum(1), learner.value(x)[:, 0], torch.as_tensor(reward), torch.as_tensor(done)))
            x = torch.as_tensor(seen)
        after, advantage, advantages = learner.value(x)[:, 0], torch.zeros(soccer.rows), []
        for _, _, _, value, reward, done in reversed(rows):
            advantage = reward + GAMMA * after * (1 - done) - value + GAMMA * LAMBDA * (1 - done) * advantage
            after = value
            advantages.insert(0, advantage)
    x_, action, logp, value = (torch.cat(part) for part in list(zip(*rows))[:4])
    advantage = torch.cat(advantages)
    return x_, action, logp, advantage, advantage + value


def update():
    x_, action, logp, advantage, target = collect()
    for _ in range(EPOCHS):
        for i in torch.randperm(len(x_)).split(MINIBATCH):
            a = advantage[i]
            learner.minibatch(x_[i], action[i], logp[i], (a - a.mean()) / (a.std() + 1e-8), target[i])


update()
count, start = 0, time.perf_counter()
while time.perf_counter() - start < 30.0:
    update()
    count += STEPS * soccer.rows
say("envpool_ppo", count / (time.perf_counter() - start))
