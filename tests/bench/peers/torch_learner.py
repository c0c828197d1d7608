"""The learner alone, in the paper's shape: 464 inputs, a batch of 128,400, minibatches of 4,280, five epochs; on one core."""
import time

import torch

from ppo import Learner
from timing import say

BATCH, MINIBATCH, EPOCHS = 128400, 4280, 5
learner = Learner(464, 2, beta=True)
x = torch.randn(BATCH, 464).clamp(-1, 1)
with torch.no_grad():
    chosen = [learner.distribution(part).sample().clamp(1e-4, 1 - 1e-4) for part in x.split(MINIBATCH)]
    logp = torch.cat([learner.distribution(p).log_prob(a).sum(1) for p, a in zip(x.split(MINIBATCH), chosen)])
action, advantage, target = torch.cat(chosen), torch.randn(BATCH), torch.randn(BATCH)
seen = 0
for limit in (2.0, 20.0):
    seen, start = 0, time.perf_counter()
    while time.perf_counter() - start < limit:
        order = torch.randperm(BATCH)[:MINIBATCH]
        learner.minibatch(x[order], action[order], logp[order], advantage[order], target[order])
        seen += MINIBATCH
    elapsed = time.perf_counter() - start
say("torch_learner", seen / elapsed / EPOCHS)
