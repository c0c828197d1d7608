"""PPO in PyTorch as people write it: two perceptrons, clipped loss, Adam, gradient norm 0.5; Beta or Gaussian actions."""
import torch
from torch import nn

torch.set_num_threads(1)


def perceptron(inputs, outputs, hidden=(256, 256)):
    layers = []
    for size in hidden:
        layers += [nn.Linear(inputs, size), nn.Tanh()]
        inputs = size
    return nn.Sequential(*layers, nn.Linear(inputs, outputs))


class Learner:
    def __init__(self, inputs, actions, beta):
        torch.manual_seed(1)
        self.beta, self.actions = beta, actions
        self.policy, self.value = perceptron(inputs, 2 * actions if beta else actions), perceptron(inputs, 1)
        self.spread = nn.Parameter(torch.zeros(actions))
        self.parameters = [*self.policy.parameters(), *self.value.parameters(), self.spread]
        self.adam = torch.optim.Adam(self.parameters, lr=4e-4)

    def distribution(self, x):
        out = self.policy(x)
        if not self.beta:
            return torch.distributions.Normal(out, self.spread.exp(), validate_args=False)
        shape = 1 + nn.functional.softplus(out)
        return torch.distributions.Beta(shape[:, : self.actions], shape[:, self.actions :], validate_args=False)

    def minibatch(self, x, action, logp, advantage, target):
        ratio = (self.distribution(x).log_prob(action).sum(1) - logp).exp()
        gain = torch.minimum(ratio * advantage, ratio.clamp(0.8, 1.2) * advantage).mean()
        loss = 0.5 * (self.value(x)[:, 0] - target).square().mean() - gain
        self.adam.zero_grad(set_to_none=True)
        loss.backward()
        nn.utils.clip_grad_norm_([p for p in self.parameters if p.grad is not None], 0.5)
        self.adam.step()
