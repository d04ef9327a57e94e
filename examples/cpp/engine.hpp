// The engine's own Vulkan: a device with one queue, buffers, images, barriers. Nothing here is Arealight's.

#pragma once

#include <vulkan/vulkan.h>

#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

constexpr uint32_t WIDTH = 256, HEIGHT = 160;

inline void check(VkResult result, const char *call) {
    if (result != VK_SUCCESS) {
        throw std::runtime_error(std::string(call) + " failed: " + std::to_string(result));
    }
}

inline VKAPI_ATTR VkBool32 VKAPI_CALL count_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                             const VkDebugUtilsMessengerCallbackDataEXT *data, void *count) {
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    ++*static_cast<int *>(count);
    return VK_FALSE;
}

struct Buffer {
    VkBuffer handle;
    VkDeviceMemory memory;
    void *mapped;
};

struct Image {
    VkImage handle;
    VkDeviceMemory memory;
    VkImageView view;
};

// The engine's device, with one queue that computes.
struct Engine {
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t family = 0;
    VkQueue queue = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memories = {};
    int messages = 0;

    explicit Engine(const std::string &validation) {
        make_instance(validation);
        choose_device();
        float priority = 1.0f;
        VkDeviceQueueCreateInfo queues = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
        queues.queueFamilyIndex = family;
        queues.queueCount = 1;
        queues.pQueuePriorities = &priority;
        VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO}; // no extension, no feature
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queues;
        check(vkCreateDevice(physical_device, &info, nullptr, &device), "vkCreateDevice");
        vkGetDeviceQueue(device, family, 0, &queue);
        vkGetPhysicalDeviceMemoryProperties(physical_device, &memories);
    }

    void make_instance(const std::string &validation) {
        VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO};
        application.apiVersion = VK_API_VERSION_1_1;
        VkDebugUtilsMessengerCreateInfoEXT messages_info = {VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
        messages_info.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        messages_info.messageType =
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
        messages_info.pfnUserCallback = count_message;
        messages_info.pUserData = &messages;
        std::vector<VkValidationFeatureEnableEXT> enabled;
        if (validation == "synchronization") {
            enabled = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
        } else if (validation == "gpu-assisted") {
            enabled = {VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,
                       VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT};
        }
        VkValidationFeaturesEXT features = {VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
        features.pNext = &messages_info;
        features.enabledValidationFeatureCount = (uint32_t)enabled.size();
        features.pEnabledValidationFeatures = enabled.data();

        const char *layer = "VK_LAYER_KHRONOS_validation";
        const char *extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
        VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
        info.pApplicationInfo = &application;
        if (!validation.empty()) {
            info.pNext = &features;
            info.enabledLayerCount = 1;
            info.ppEnabledLayerNames = &layer;
            info.enabledExtensionCount = 1;
            info.ppEnabledExtensionNames = &extension;
        }
        check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
        if (!validation.empty()) {
            auto make = (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance,
                                                                                  "vkCreateDebugUtilsMessengerEXT");
            check(make(instance, &messages_info, nullptr, &messenger), "vkCreateDebugUtilsMessengerEXT");
        }
    }

    // Whether AREALIGHT_DEVICE, where it is set, means a device: its number, or a part of its name.
    static bool is_wanted(VkPhysicalDevice device, size_t number) {
        const char *wanted = std::getenv("AREALIGHT_DEVICE");
        if (!wanted) {
            return true;
        }
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        auto lower = [](std::string text) {
            for (char &letter : text) {
                letter = (char)std::tolower((unsigned char)letter);
            }
            return text;
        };
        return std::to_string(number) == wanted
               || lower(properties.deviceName).find(lower(wanted)) != std::string::npos;
    }

    // Takes the first device that is wanted and has a queue which computes.
    void choose_device() {
        uint32_t count = 0;
        check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
        std::vector<VkPhysicalDevice> devices(count);
        check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
        for (size_t number = 0; number < devices.size(); number++) {
            VkPhysicalDevice candidate = devices[number];
            if (!is_wanted(candidate, number)) {
                continue;
            }
            uint32_t family_count = 0;
            vkGetPhysicalDeviceQueueFamilyProperties(candidate, &family_count, nullptr);
            std::vector<VkQueueFamilyProperties> families(family_count);
            vkGetPhysicalDeviceQueueFamilyProperties(candidate, &family_count, families.data());
            for (family = 0; family < family_count; family++) {
                if (families[family].queueFlags & VK_QUEUE_COMPUTE_BIT) {
                    physical_device = candidate;
                    return;
                }
            }
        }
        throw std::runtime_error("no Vulkan device with a compute queue, or none that AREALIGHT_DEVICE means");
    }

    VkDeviceMemory allocate(uint64_t size, uint32_t type_bits, VkMemoryPropertyFlags wanted) {
        for (uint32_t type = 0; type < memories.memoryTypeCount; type++) {
            bool has = (memories.memoryTypes[type].propertyFlags & wanted) == wanted;
            if ((type_bits >> type & 1) && has) {
                VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
                info.allocationSize = size;
                info.memoryTypeIndex = type;
                VkDeviceMemory memory;
                check(vkAllocateMemory(device, &info, nullptr, &memory), "vkAllocateMemory");
                return memory;
            }
        }
        throw std::runtime_error("no memory of the type that is needed");
    }

    // A buffer that the CPU writes and reads.
    Buffer buffer(uint64_t size, VkBufferUsageFlags usage, const void *content = nullptr) {
        VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
        info.size = size;
        info.usage = usage;
        Buffer made = {};
        check(vkCreateBuffer(device, &info, nullptr, &made.handle), "vkCreateBuffer");
        VkMemoryRequirements needed;
        vkGetBufferMemoryRequirements(device, made.handle, &needed);
        made.memory = allocate(needed.size, needed.memoryTypeBits,
                               VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        check(vkBindBufferMemory(device, made.handle, made.memory, 0), "vkBindBufferMemory");
        check(vkMapMemory(device, made.memory, 0, VK_WHOLE_SIZE, 0, &made.mapped), "vkMapMemory");
        if (content) {
            std::memcpy(made.mapped, content, size);
        }
        return made;
    }

    Image image(VkFormat format, VkImageUsageFlags usage) {
        VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {WIDTH, HEIGHT, 1};
        info.mipLevels = 1;
        info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = usage;
        Image made = {};
        check(vkCreateImage(device, &info, nullptr, &made.handle), "vkCreateImage");
        VkMemoryRequirements needed;
        vkGetImageMemoryRequirements(device, made.handle, &needed);
        made.memory = allocate(needed.size, needed.memoryTypeBits, 0);
        check(vkBindImageMemory(device, made.handle, made.memory, 0), "vkBindImageMemory");
        VkImageViewCreateInfo view = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = made.handle;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        check(vkCreateImageView(device, &view, nullptr, &made.view), "vkCreateImageView");
        return made;
    }

    void destroy(const Buffer &buffer) {
        vkDestroyBuffer(device, buffer.handle, nullptr);
        vkFreeMemory(device, buffer.memory, nullptr);
    }

    void destroy(const Image &image) {
        vkDestroyImageView(device, image.view, nullptr);
        vkDestroyImage(device, image.handle, nullptr);
        vkFreeMemory(device, image.memory, nullptr);
    }

    // Destroys the device, and returns how many messages of the validation layer there were.
    int close() {
        vkDestroyDevice(device, nullptr);
        if (messenger) {
            auto destroy_messenger = (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                instance, "vkDestroyDebugUtilsMessengerEXT");
            destroy_messenger(instance, messenger, nullptr);
        }
        vkDestroyInstance(instance, nullptr);
        return messages;
    }
};

inline void barrier(VkCommandBuffer commands, VkImage image, VkPipelineStageFlags before, VkAccessFlags written,
             VkImageLayout from, VkPipelineStageFlags after, VkAccessFlags next, VkImageLayout to) {
    VkImageMemoryBarrier info = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    info.srcAccessMask = written;
    info.dstAccessMask = next;
    info.oldLayout = from;
    info.newLayout = to;
    info.srcQueueFamilyIndex = info.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    info.image = image;
    info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, before, after, 0, 0, nullptr, 0, nullptr, 1, &info);
}

inline VkBufferImageCopy whole_image() {
    VkBufferImageCopy copy = {};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {WIDTH, HEIGHT, 1};
    return copy;
}
