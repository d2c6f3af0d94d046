#!/usr/bin/env python3
"""Soft actor-critic in PyTorch, in the form of CleanRL's sac_continuous_action.py: the yardstick of the learner.

    pip install torch numpy
    python3 learner/bench/cleanrl_sac.py bench --updates 300 --threads 1
    python3 learner/bench/cleanrl_sac.py vector learner/tests/pytorch_vector.json

`bench` prints a line of CSV like `learner bench`: state 28, action 14, batch 256, every update one step of both
critics, the actor, the temperature and the targets. `vector` writes a small network's parameters, batches and
noise, and what three updates make of them; there log sigma is clamped and the correction exact, as in
the learner, where CleanRL squashes log sigma and adds 1e-6. Written with torch 2.15.
"""

import argparse
import json
import math
import time

import torch
import torch.nn.functional as F

GAMMA, TAU, RATE = 0.99, 0.005, 3e-4


class Critic(torch.nn.Module):
    def __init__(self, states, actions, hidden):
        super().__init__()
        self.fc1 = torch.nn.Linear(states + actions, hidden)
        self.fc2 = torch.nn.Linear(hidden, hidden)
        self.fc3 = torch.nn.Linear(hidden, 1)

    def forward(self, x, a):
        x = F.relu(self.fc1(torch.cat([x, a], 1)))
        return self.fc3(F.relu(self.fc2(x)))


class Actor(torch.nn.Module):
    def __init__(self, states, actions, hidden, exact):
        super().__init__()
        self.fc1 = torch.nn.Linear(states, hidden)
        self.fc2 = torch.nn.Linear(hidden, hidden)
        self.fc_mean = torch.nn.Linear(hidden, actions)
        self.fc_logstd = torch.nn.Linear(hidden, actions)
        self.exact = exact

    def sample(self, x, noise=None):
        x = F.relu(self.fc2(F.relu(self.fc1(x))))
        mean, log_std = self.fc_mean(x), self.fc_logstd(x)
        if self.exact:
            log_std = torch.clamp(log_std, -20.0, 2.0)
        else:
            log_std = -5 + 0.5 * (2 + 5) * (torch.tanh(log_std) + 1)
        normal = torch.distributions.Normal(mean, log_std.exp())
        u = normal.rsample() if noise is None else mean + log_std.exp() * noise
        a = torch.tanh(u)
        log_prob = normal.log_prob(u)
        if self.exact:
            log_prob = log_prob - 2 * (math.log(2) - u - F.softplus(-2 * u))
        else:
            log_prob = log_prob - torch.log(1 - a.pow(2) + 1e-6)
        return a, log_prob.sum(1, keepdim=True)


class Sac:
    def __init__(self, states, actions, hidden, exact=False):
        self.actor = Actor(states, actions, hidden, exact)
        self.qf1, self.qf2 = Critic(states, actions, hidden), Critic(states, actions, hidden)
        self.qf1_target, self.qf2_target = Critic(states, actions, hidden), Critic(states, actions, hidden)
        self.qf1_target.load_state_dict(self.qf1.state_dict())
        self.qf2_target.load_state_dict(self.qf2.state_dict())
        self.q_optimizer = torch.optim.Adam([*self.qf1.parameters(), *self.qf2.parameters()], lr=RATE)
        self.actor_optimizer = torch.optim.Adam(self.actor.parameters(), lr=RATE)
        self.log_alpha = torch.zeros(1, requires_grad=True)
        self.a_optimizer = torch.optim.Adam([self.log_alpha], lr=RATE)
        self.target_entropy = -float(actions)

    def update(self, s, a, r, done, s2, noise2=None, noise=None):
        alpha = self.log_alpha.exp().item()
        with torch.no_grad():
            a2, log_pi2 = self.actor.sample(s2, noise2)
            q = torch.min(self.qf1_target(s2, a2), self.qf2_target(s2, a2)) - alpha * log_pi2
            y = r + (1 - done) * GAMMA * q.view(-1)
        loss1 = F.mse_loss(self.qf1(s, a).view(-1), y)
        loss2 = F.mse_loss(self.qf2(s, a).view(-1), y)
        self.q_optimizer.zero_grad()
        (loss1 + loss2).backward()
        self.q_optimizer.step()

        pi, log_pi = self.actor.sample(s, noise)
        actor_loss = (alpha * log_pi - torch.min(self.qf1(s, pi), self.qf2(s, pi))).mean()
        self.actor_optimizer.zero_grad()
        actor_loss.backward()
        self.actor_optimizer.step()

        log_pi = log_pi.detach()  # CleanRL samples once more; the learner does not
        alpha_loss = (-self.log_alpha.exp() * (log_pi + self.target_entropy)).mean()
        self.a_optimizer.zero_grad()
        alpha_loss.backward()
        self.a_optimizer.step()

        for online, target in [(self.qf1, self.qf1_target), (self.qf2, self.qf2_target)]:
            for parameter, slow in zip(online.parameters(), target.parameters()):
                slow.data.copy_(TAU * parameter.data + (1 - TAU) * slow.data)
        return (loss1 + loss2) / 2, actor_loss, alpha_loss


def bench(args):
    torch.set_num_threads(args.threads)
    torch.manual_seed(1)
    robots, rows = args.robots, 10_000
    sac = Sac(2 * robots, robots, 256)
    s, s2 = torch.rand(rows, 2 * robots) * 2 - 1, torch.rand(rows, 2 * robots) * 2 - 1
    a = torch.rand(rows, robots) * 2 - 1
    r, done = 0.2 * a[:, 0], torch.zeros(rows)

    def update():
        index = torch.randint(rows, (args.batch,))
        sac.update(s[index], a[index], r[index], done[index], s2[index])

    for _ in range(20):
        update()
    clock, cpu = time.perf_counter(), time.process_time()
    for _ in range(args.updates):
        update()
    seconds, cpu = time.perf_counter() - clock, time.process_time() - cpu
    print(f"pytorch,{robots},{args.batch},{args.threads},{args.updates},{seconds:.3f},{cpu:.3f},"
          f"{args.updates / seconds:.1f},{args.updates / cpu:.1f}")


def flat(*layers):
    """Weights and biases in the learner's order."""
    return [number for layer in layers for part in (layer.weight, layer.bias) for number in part.flatten().tolist()]


def parameters(sac):
    heads = torch.nn.Linear(1, 1)  # Both heads are one layer there: means first.
    heads.weight = torch.nn.Parameter(torch.cat([sac.actor.fc_mean.weight, sac.actor.fc_logstd.weight]))
    heads.bias = torch.nn.Parameter(torch.cat([sac.actor.fc_mean.bias, sac.actor.fc_logstd.bias]))
    critic = lambda q: flat(q.fc1, q.fc2, q.fc3)
    return {
        "actor": flat(sac.actor.fc1, sac.actor.fc2, heads),
        "critics": [critic(sac.qf1), critic(sac.qf2)],
        "targets": [critic(sac.qf1_target), critic(sac.qf2_target)],
        "log_alpha": sac.log_alpha.item(),
    }


def vector(args):
    torch.manual_seed(3)
    states, actions, hidden, batch = 4, 2, 8, 6
    sac = Sac(states, actions, hidden, exact=True)
    with torch.no_grad():
        for target in (sac.qf1_target, sac.qf2_target):
            for parameter in target.parameters():
                parameter += 0.1 * torch.randn_like(parameter)
    out = {"states": states, "actions": actions, "hidden": hidden, "batch": batch, "before": parameters(sac), "updates": []}
    for _ in range(3):
        s, s2 = torch.randn(batch, states), torch.randn(batch, states)
        a, r = torch.tanh(torch.randn(batch, actions)), torch.randn(batch)
        done = torch.tensor([0.0, 1.0, 0.0, 0.0, 1.0, 0.0])
        noise2, noise = torch.randn(batch, actions), torch.randn(batch, actions)
        critic, actor, alpha = sac.update(s, a, r, done, s2, noise2, noise)
        tensors = dict(s=s, a=a, r=r, done=done, s2=s2, noise2=noise2, noise=noise)
        losses = {"critic": critic.item(), "actor": actor.item(), "alpha": alpha.item()}
        out["updates"].append({**{name: tensor.flatten().tolist() for name, tensor in tensors.items()}, **losses})
    out["after"] = parameters(sac)
    with open(args.file, "w") as file:
        json.dump(out, file)
        file.write("\n")


arguments = argparse.ArgumentParser()
commands = arguments.add_subparsers(required=True)
command = commands.add_parser("bench")
command.add_argument("--robots", type=int, default=14)
command.add_argument("--batch", type=int, default=256)
command.add_argument("--updates", type=int, default=300)
command.add_argument("--threads", type=int, default=1)
command.set_defaults(run=bench)
command = commands.add_parser("vector")
command.add_argument("file")
command.set_defaults(run=vector)
args = arguments.parse_args()
args.run(args)
